// SPDX-License-Identifier: BSD-3-Clause
#include "segments/evidence.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace gaussmap::detail {
namespace {

constexpr double kLongest = 10.0;  // the limit of particles grows with the length only up to this many times min_length
constexpr double kBin = 0.25;      // length of the bins of ParticleLimit::Bins [m]
constexpr std::uint64_t kObservations = 0x6a09e667f3bcc909;  // gives add() other random numbers than the samples

class MomentCells : public EvidenceKeeper {
 public:
  void add(const std::vector<ObservationPoint>& observation, double, std::uint64_t,
           SegmentEvidence& evidence) const override {
    LineMoments moments;
    for (const ObservationPoint& point : observation) moments.add(point.position, point.weight);
    evidence.row.at(evidence.row.index(moments.mean())).hits += moments;
  }
  void settle(std::uint64_t, SegmentEvidence&) const override {}
};

class ParticleSets : public EvidenceKeeper {
 public:
  ParticleSets(const ParticleOptions& options, double min_length)
      : options_(options), longest_(kLongest * min_length) {}

  void add(const std::vector<ObservationPoint>& observation, double length, std::uint64_t number,
           SegmentEvidence& evidence) const override {
    const bool per_segment = options_.limit == ParticleLimit::Segment, as_they_are = areParticles(observation);
    if (per_segment || !as_they_are) {
      Random random = Random::forPart(options_.seed ^ kObservations, number);
      if (per_segment) makeRoom(length, random, evidence.particles);
      if (!as_they_are) return draw(observation, random, evidence.particles);
    }
    for (const ObservationPoint& point : observation) evidence.particles.push_back(point.position.cast<float>());
  }

  void settle(std::uint64_t number, SegmentEvidence& evidence) const override {
    if (options_.limit == ParticleLimit::Bins) {
      Random random = Random::forPart(options_.seed, number);
      limitBins(random, evidence);
    }
    if (4 * evidence.particles.capacity() > 5 * evidence.particles.size()) evidence.particles.shrink_to_fit();
    for (SegmentCell& cell : evidence.row.cells()) cell.hits = LineMoments();
    const double weight = 1.0 / options_.samples;
    for (const Particle& particle : evidence.particles) evidence.row.add(particle.cast<double>(), weight);
    evidence.row.trim();
  }

 private:
  /// Returns true if the points are M particles of equal weight.
  bool areParticles(const std::vector<ObservationPoint>& points) const {
    return points.size() == static_cast<std::size_t>(options_.samples) &&
           std::all_of(points.begin(), points.end(), [&](const ObservationPoint& point) {
             return std::abs(point.weight - points[0].weight) <= 1e-9 * points[0].weight;
           });
  }

  /// Draws M particles by the weights of the points (systematic resampling).
  void draw(const std::vector<ObservationPoint>& points, Random& random, std::vector<Particle>& particles) const {
    double total = 0.0, passed = 0.0;
    for (const ObservationPoint& point : points) total += point.weight;
    const double step = total / options_.samples, first = random.uniform() * step;
    std::size_t at = 0;
    for (int i = 0; i < options_.samples; ++i) {
      while (at + 1 < points.size() && passed + points[at].weight <= first + i * step) passed += points[at++].weight;
      particles.push_back(points[at].position.cast<float>());
    }
  }

  /// Deletes random particles, without replacement, until M more are within the limit, Leal 2000 sec. 4.4.
  void makeRoom(double length, Random& random, std::vector<Particle>& particles) const {
    const double limit = options_.per_metre * std::min(length, longest_) - options_.samples;
    while (!particles.empty() && static_cast<double>(particles.size()) > limit) {
      std::swap(particles[random.below(particles.size())], particles.back());
      particles.pop_back();
    }
  }

  /// Deletes random particles of the bins that have too many.
  void limitBins(Random& random, SegmentEvidence& evidence) const {
    const double per_bin = options_.per_metre * kBin;
    const std::size_t limit = static_cast<std::size_t>(std::max(per_bin, double(options_.samples)));
    const auto binOf = [&](const Particle& particle) {
      return static_cast<int>(std::floor(evidence.row.position(particle.cast<double>()) / kBin));
    };
    int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
    std::vector<int> bins;
    for (const Particle& particle : evidence.particles) {
      bins.push_back(binOf(particle));
      first = std::min(first, bins.back());
      last = std::max(last, bins.back());
    }
    // Sorts the particles by bin (counting sort), then keeps at most `limit` random ones per bin.
    std::vector<std::size_t> ends(static_cast<std::size_t>(std::int64_t{last} - first + 2), 0);
    for (const int bin : bins) ++ends[static_cast<std::size_t>(std::int64_t{bin} - first + 1)];
    for (std::size_t i = 1; i < ends.size(); ++i) ends[i] += ends[i - 1];
    std::vector<Particle> sorted(bins.size());
    std::vector<std::size_t> at = ends;
    for (std::size_t i = 0; i < bins.size(); ++i)
      sorted[at[static_cast<std::size_t>(bins[i] - first)]++] = evidence.particles[i];
    evidence.particles.clear();
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      std::size_t left = ends[i + 1] - ends[i];
      for (; left > limit; --left) std::swap(sorted[ends[i] + random.below(left)], sorted[ends[i] + left - 1]);
      for (std::size_t k = 0; k < left; ++k) evidence.particles.push_back(sorted[ends[i] + k]);
    }
  }

  ParticleOptions options_;
  double longest_;  // [m]
};

}  // namespace

SegmentEvidence SegmentEvidence::slice(std::size_t first, std::size_t last) const {
  SegmentEvidence part;
  part.row = row.slice(first, last);
  const int from = row.first() + static_cast<int>(first), to = row.first() + static_cast<int>(last);
  for (const Particle& particle : particles) {
    const int index = row.index(particle.cast<double>());
    if (index >= from && index < to) part.particles.push_back(particle);
  }
  return part;
}

void SegmentEvidence::absorb(const SegmentEvidence& other) {
  row.absorb(other.row);
  particles.insert(particles.end(), other.particles.begin(), other.particles.end());
}

std::unique_ptr<EvidenceKeeper> makeEvidenceKeeper(const SegmentFitterOptions& options) {
  if (options.policy == EvidencePolicy::ParticleSets)
    return std::make_unique<ParticleSets>(options.particles, options.min_length);
  return std::make_unique<MomentCells>();
}

}  // namespace gaussmap::detail
