// SPDX-License-Identifier: BSD-3-Clause
#include "segments/evidence_collector.h"

namespace gaussmap::detail {
namespace {

std::unique_ptr<ObservationModel> observationModel(const SegmentFitterOptions& options) {
  if (options.policy == EvidencePolicy::ParticleSets)
    return std::make_unique<SampledObservations>(options.noise, options.particles.samples, options.particles.seed);
  return std::make_unique<UnscentedObservations>(options.noise);
}

}  // namespace

EvidenceCollector::EvidenceCollector(const SegmentFitterOptions& options)
    : noise_(options.noise), model_(observationModel(options)), keeper_(makeEvidenceKeeper(options)) {}

void EvidenceCollector::take(const ScanBeams& beams, std::size_t beam, LiveSegment& segment) {
  model_->observe(beams.scan, beam, beams.first_number + beam, points_);
  keeper_->add(points_, segment.evidence);
  const Vector<2>& hit = beams.hits[beam];
  const double t = segment.line.position(hit), range = beams.scan.ranges[beam];
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
  keeper_->settle(segment.length(), settled_++, segment.evidence);
  refit(segment);
}

}  // namespace gaussmap::detail
