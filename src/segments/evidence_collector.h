// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "gaussmap/segments/segment_fitter.h"
#include "segments/live_segment.h"
#include "segments/scan_beams.h"

namespace gaussmap::detail {

/// Adds the beams of a scan to the evidence of the segments that they belong to.
class EvidenceCollector {
 public:
  /// Without a model, the options choose it.
  EvidenceCollector(const SegmentFitterOptions& options, std::shared_ptr<const ObservationModel> model);

  /// Computes the observations of a scan. Call it first. Throws std::invalid_argument if a model of the user returns
  /// unusable points.
  void observe(const ScanBeams& beams);
  /// Returns the mean of the points of an observation [m].
  Vector<2> mean(std::size_t beam) const;
  /// Adds one beam to a segment.
  void take(const ScanBeams& beams, std::size_t beam, LiveSegment& segment);
  /// Call it after all beams of scan number `scan`. Adds the errors of the scan, drops the evidence beyond the limit,
  /// and fits the line.
  void settle(const ScanBeams& beams, std::int64_t scan, LiveSegment& segment);

 private:
  SensorNoise noise_;
  bool is_users_;  // the model comes from the user
  std::shared_ptr<const ObservationModel> model_;
  std::unique_ptr<EvidenceKeeper> keeper_;
  std::uint64_t settled_ = 0;                          // calls of settle(); seeds the random numbers of each call
  std::vector<std::vector<ObservationPoint>> points_;  // per beam of the current scan; old ones without a return
};

}  // namespace gaussmap::detail
