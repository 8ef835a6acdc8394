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

/// Turns the beams of a scan into evidence of the segments that they belong to.
class EvidenceCollector {
 public:
  explicit EvidenceCollector(const SegmentFitterOptions& options);

  /// Adds one beam to a segment.
  void take(const ScanBeams& beams, std::size_t beam, LiveSegment& segment);
  /// After all beams of scan number `scan`: adds the errors of the scan, forgets evidence beyond the limit, fits the
  /// line.
  void settle(const ScanBeams& beams, std::int64_t scan, LiveSegment& segment);

 private:
  SensorNoise noise_;
  std::unique_ptr<ObservationModel> model_;
  std::unique_ptr<EvidenceKeeper> keeper_;
  std::uint64_t settled_ = 0;             // a number for the random generator of each call
  std::vector<ObservationPoint> points_;  // of the beam at hand
};

}  // namespace gaussmap::detail
