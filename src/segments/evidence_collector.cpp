// SPDX-License-Identifier: BSD-3-Clause
#include "segments/evidence_collector.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/number_text.h"

namespace gaussmap::detail {
namespace {

std::shared_ptr<const ObservationModel> observationModel(const SegmentFitterOptions& options) {
  if (options.policy == EvidencePolicy::ParticleSets)
    return std::make_shared<SampledObservations>(options.noise, options.particles.samples, options.particles.seed);
  return std::make_shared<UnscentedObservations>(options.noise);
}

/// Throws std::invalid_argument if these are not the points of an observation.
void check(const std::vector<ObservationPoint>& points, std::size_t beam) {
  const auto fail = [&](const std::string& what) {
    throw std::invalid_argument("observation model: beam " + std::to_string(beam) + ": " + what);
  };
  double sum = 0.0;
  for (const ObservationPoint& point : points) {
    if (!point.position.allFinite()) fail("a point is not finite");
    if (!(point.weight >= 0.0)) fail("weight = " + numberText(point.weight) + ": must not be negative");
    sum += point.weight;
  }
  if (!(std::abs(sum - 1.0) <= 1e-6)) fail("the weights sum to " + numberText(sum) + ", not to 1");
}

}  // namespace

EvidenceCollector::EvidenceCollector(const SegmentFitterOptions& options, std::shared_ptr<const ObservationModel> model)
    : noise_(options.noise),
      is_users_(model != nullptr),
      model_(model ? std::move(model) : observationModel(options)),
      keeper_(makeEvidenceKeeper(options)) {}

void EvidenceCollector::observe(const ScanBeams& beams) {
  if (points_.size() < beams.hits.size()) points_.resize(beams.hits.size());
  for (std::size_t beam = 0; beam < beams.hits.size(); ++beam) {
    if (!beams.scan.returned(beam)) continue;
    model_->observe(beams.scan, beam, beams.first_number + beam, points_[beam]);
    if (is_users_) check(points_[beam], beam);
  }
}

Vector<2> EvidenceCollector::mean(std::size_t beam) const {
  Vector<2> sum(0.0, 0.0);
  double weight = 0.0;
  for (const ObservationPoint& point : points_[beam]) {
    sum += point.weight * point.position;
    weight += point.weight;
  }
  return sum / weight;
}

void EvidenceCollector::take(const ScanBeams& beams, std::size_t beam, LiveSegment& segment) {
  const Vector<2>& hit = beams.hits[beam];
  const double t = segment.line.position(hit), range = beams.scan.ranges[beam];
  segment.begin = std::min(segment.begin, t);  // until settle() computes them, for the limit of particles
  segment.end = std::max(segment.end, t);
  keeper_->add(points_[beam], segment.length(), beams.first_number + beam, segment.evidence);
  const Vector<2> back = (beams.sensor() - hit) / range;
  segment.view += back;
  segment.beams.n += 1.0;
  segment.beams.t += t;
  segment.beams.tt += t * t;
  // Variance across the line: the range error acts along the beam, the bearing error at right angles to it.
  const double sine = segment.line.normal().dot(back), bearing = range * noise_.bearing;
  segment.beams.variance += sine * sine * noise_.range * noise_.range + (1.0 - sine * sine) * bearing * bearing;
}

void EvidenceCollector::settle(const ScanBeams& beams, std::int64_t scan, LiveSegment& segment) {
  segment.spread.addScan(segment.beams, segment.line, beams.sensor(), beams.scan.pose.covariance, scan);
  segment.beams = BeamSums();
  segment.last_seen = scan;
  keeper_->settle(settled_++, segment.evidence);
  refit(segment);
}

}  // namespace gaussmap::detail
