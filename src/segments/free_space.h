// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "segments/live_segment.h"
#include "segments/scan_beams.h"

namespace gaussmap::detail {

/// Adds to every cell the rays that went through it and ended well behind, times `weight`.
void countCrossings(const ScanBeams& beams, double weight, std::deque<LiveSegment>& segments);

/// A few of the scans: one per half metre and quarter of a radian of heading. They show which places rays have passed
/// through, for segments that are made later.
class Views {
 public:
  /// Keeps the scan, or counts it as a repetition of the one that was kept near by.
  void add(const LaserScan& scan);
  /// Sets the crossings of all cells to those of the kept scans.
  void countCrossings(std::deque<LiveSegment>& segments) const;
  std::size_t bytes() const;

 private:
  struct View {
    Vector<2> sensor{0.0, 0.0};
    double heading = 0.0;
    double scans = 0.0;                                  // that it represents
    std::shared_ptr<const std::vector<float>> bearings;  // most scans have the same
    std::vector<float> ranges;                           // 0: no return
  };
  std::map<std::array<std::int64_t, 3>, View> views_;
  std::shared_ptr<const std::vector<float>> bearings_;  // of the last one that was kept
};

}  // namespace gaussmap::detail
