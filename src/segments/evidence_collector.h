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
  explicit EvidenceCollector(const SegmentFitterOptions& options);

  /// Adds one beam to a segment.
  void take(const ScanBeams& beams, std::size_t beam, LiveSegment& segment);
  /// Call it after all beams of scan number `scan`. Adds the errors of the scan, drops the evidence beyond the limit,
  /// and fits the line.
  void settle(const ScanBeams& beams, std::int64_t scan, LiveSegment& segment);

 private:
  SensorNoise noise_;
  std::unique_ptr<ObservationModel> model_;
  std::unique_ptr<EvidenceKeeper> keeper_;
  std::uint64_t settled_ = 0;             // calls of settle(); seeds the random numbers of each call
  std::vector<ObservationPoint> points_;  // of the current beam
};

}  // namespace gaussmap::detail
