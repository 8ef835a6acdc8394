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

/// Adds `weight` to SegmentCell::crossed for each ray that passed through the cell and ended well behind it.
void countCrossings(const ScanBeams& beams, double weight, std::deque<LiveSegment>& segments);

/// Keeps one scan per half metre of position and quarter radian of heading. The kept scans show where rays have passed
/// through segments that are created later.
class Views {
 public:
  /// Keeps the scan. If a scan of the same place and heading is already kept, counts this one as its repetition.
  void add(const LaserScan& scan);
  /// Replaces the crossings of all cells by those of the kept scans.
  void countCrossings(std::deque<LiveSegment>& segments) const;
  std::size_t bytes() const;

 private:
  struct View {
    Vector<2> sensor{0.0, 0.0};
    double heading = 0.0;
    double scans = 0.0;                                  // number of scans that it represents
    std::shared_ptr<const std::vector<float>> bearings;  // shared, because they are the same in most scans
    std::vector<float> ranges;                           // 0: no return
  };
  std::map<std::array<std::int64_t, 3>, View> views_;
  std::shared_ptr<const std::vector<float>> bearings_;  // of the last one that was kept
};

}  // namespace gaussmap::detail
