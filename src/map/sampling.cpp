// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/sampling.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "gaussmap/map/queries.h"
#include "map/member_boxes.h"
#include "map/sample_within.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr std::size_t kGrain = 16;  // Gaussians per task

std::size_t maxTries(std::size_t count) {
  return 1000 + 200 * count;
}

/// Returns a number that identifies one Gaussian. It does not change if other cells are added or removed.
template <int D>
std::uint64_t partOf(int scale, const CellKey<D>& key, std::size_t rank) {
  std::uint64_t part = Random(static_cast<std::uint64_t>(scale)).bits();
  for (const std::int32_t coordinate : key) part = Random(part ^ static_cast<std::uint32_t>(coordinate)).bits();
  return Random(part ^ rank).bits();
}

/// Draws at most `count` samples of one Gaussian into the slots from `first` on. Returns the number of samples drawn.
/// `box` can be null.
template <int D>
std::size_t sampleOne(const GaussianMap<D>& map, int scale, std::size_t index, const Box<D>* box, std::uint64_t seed,
                      std::size_t first, std::size_t count, MapSamples<D>& samples) {
  const std::size_t cell = map.cellOf(index, scale);
  const CellKey<D>& key = map.scale(scale).keys[cell];
  const Vector<D> centre = map.grid().centre(key, scale);
  const GaussianSampler<D> sampler(map.localGaussian(index, scale));
  // A cell contains the points from half a lattice step below its lower face to half a step below its upper face.
  // Samples stay half a step away from both ends, so the sum with the centre cannot round into the next cell.
  const double step = map.grid().side(0) / static_cast<double>(kStepsPerCell), half = 0.5 * map.grid().side(scale);
  Vector<D> lowest = Vector<D>::Constant(-half), highest = Vector<D>::Constant(half - step);
  if (box != nullptr) {
    lowest = lowest.cwiseMax(box->low - centre);
    highest = highest.cwiseMin(box->high - centre - Vector<D>::Constant(step));
  }

  Random random = Random::forPart(seed, partOf<D>(scale, key, index - map.gaussiansOf(cell, scale).first));
  std::size_t placed = 0;
  for (std::size_t tries = maxTries(count); placed < count && tries > 0; --tries) {
    const Vector<D> standard = GaussianSampler<D>::standard(random);
    const Vector<D> offset = sampler.fromStandard(standard);
    if (!((offset.array() >= lowest.array()).all() && (offset.array() <= highest.array()).all())) continue;
    samples.points[first + placed] = centre + offset;
    samples.mahalanobis[first + placed] = standard.norm();
    ++placed;
  }
  return placed;
}

/// Moves the samples together to close the gaps of empty slots.
template <int D>
void closeGaps(const std::vector<std::size_t>& first, const std::vector<std::size_t>& placed, MapSamples<D>& samples) {
  std::size_t end = 0;
  for (std::size_t g = 0; g < placed.size(); ++g) {
    for (std::size_t i = 0; i < placed[g]; ++i, ++end) {
      samples.points[end] = samples.points[first[g] + i];
      samples.gaussian[end] = samples.gaussian[first[g] + i];
      samples.mahalanobis[end] = samples.mahalanobis[first[g] + i];
    }
  }
  samples.unplaced = samples.points.size() - end;
  samples.points.resize(end);
  samples.gaussian.resize(end);
  samples.mahalanobis.resize(end);
}

template <int D>
std::vector<std::size_t> countsOf(const GaussianMap<D>& map, const std::vector<GaussianId>& chosen,
                                  const SampleOptions& options) {
  std::vector<double> shares(chosen.size());
  parallelFor(shares.size(), options.threads, 1024, [&](std::size_t i) {
    const Gaussian<D> gaussian = map.localGaussian(chosen[i].index, chosen[i].scale);
    shares[i] =
        options.share == SampleShare::Volume ? std::exp(0.5 * logDeterminant<D>(gaussian.cov)) : gaussian.weight;
  });
  double sum = 0.0;  // sequential: a parallel sum would have another rounding error
  for (const double share : shares) sum += share;
  std::vector<std::size_t> counts(shares.size());
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double fair = std::round(static_cast<double>(options.samples) * (shares[i] / sum));
    counts[i] = std::max(options.at_least, static_cast<std::size_t>(fair));
  }
  return counts;
}

/// Samples the chosen Gaussians, each within its box. If `boxes` is empty, only the cells limit the samples.
template <int D>
MapSamples<D> sampleChosen(const GaussianMap<D>& map, const std::vector<GaussianId>& chosen,
                           const std::vector<Box<D>>& boxes, const SampleOptions& options) {
  const std::vector<std::size_t> counts = countsOf<D>(map, chosen, options);
  std::vector<std::size_t> first(counts.size()), placed(counts.size());
  std::size_t total = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    first[i] = total;
    total += counts[i];
  }
  MapSamples<D> samples;
  samples.points.resize(total);
  samples.gaussian.resize(total);
  samples.mahalanobis.resize(total);
  parallelFor(counts.size(), options.threads, kGrain, [&](std::size_t i) {
    const Box<D>* const box = boxes.empty() ? nullptr : &boxes[i];
    placed[i] = sampleOne<D>(map, chosen[i].scale, chosen[i].index, box, options.seed, first[i], counts[i], samples);
    std::fill_n(samples.gaussian.begin() + static_cast<std::ptrdiff_t>(first[i]), placed[i],
                static_cast<std::uint32_t>(i));
  });
  if (placed != counts) closeGaps<D>(first, placed, samples);
  return samples;
}

}  // namespace

SampleOptions SampleOptions::yguel2009() {
  SampleOptions options;
  options.at_least = 0;
  options.share = SampleShare::Volume;
  options.bounds = SampleBounds::Cell;
  return options;
}

template <int D>
std::vector<Vector<D>> MapSamples<D>::within(double sigmas) const {
  std::vector<Vector<D>> kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (mahalanobis[i] <= sigmas) kept.push_back(points[i]);
  return kept;
}

template <int D>
std::vector<std::size_t> sampleCounts(const GaussianMap<D>& map, int scale, const SampleOptions& options) {
  return countsOf<D>(map, gaussiansOfScale<D>(map, scale), options);
}

template <int D>
MapSamples<D> detail::sampleWithin(const GaussianMap<D>& map, int scale, const std::vector<Box<D>>& boxes,
                                   const SampleOptions& options) {
  return sampleChosen<D>(map, gaussiansOfScale<D>(map, scale), boxes, options);
}

template <int D>
MapSamples<D> sampleMap(const GaussianMap<D>& map, int scale, const SampleOptions& options) {
  const std::vector<GaussianId> chosen = gaussiansOfScale<D>(map, scale);
  const bool boxed = options.bounds == SampleBounds::MemberCells && scale > 0;
  return sampleChosen<D>(map, chosen, boxed ? memberBoxes<D>(map, scale) : std::vector<Box<D>>(), options);
}

template <int D>
MapSamples<D> sampleLeaves(const GaussianMap<D>& map, const SampleOptions& options) {
  return sampleChosen<D>(map, leaves<D>(map), {}, options);
}

#define GAUSSMAP_INSTANTIATE(D)                                                                            \
  template struct MapSamples<D>;                                                                           \
  template std::vector<std::size_t> sampleCounts<D>(const GaussianMap<D>&, int, const SampleOptions&);     \
  template MapSamples<D> detail::sampleWithin<D>(const GaussianMap<D>&, int, const std::vector<Box<(D)>>&, \
                                                 const SampleOptions&);                                    \
  template MapSamples<D> sampleMap<D>(const GaussianMap<D>&, int, const SampleOptions&);                   \
  template MapSamples<D> sampleLeaves<D>(const GaussianMap<D>&, const SampleOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
