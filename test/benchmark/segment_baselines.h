// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_map.h"

// What is usually done where gaussmap takes SegmentFitter.
namespace gaussmap::benchmark {

struct EndPointFitOptions {
  double threshold = 0.08;  ///< greatest distance of a point from the chord [m]
  double gap = 0.5;         ///< neighbouring beams farther apart are not of one piece [m]
  std::size_t points = 5;   ///< least of a piece
  double merge = 0.1;       ///< greatest distance of a piece's ends from the line that takes it [m]
  double merge_deg = 10.0;  ///< greatest angle between both [degree]
  double merge_gap = 0.3;   ///< greatest gap between both along the line [m]
};

/// Iterative end-point fit of every scan (Duda and Hart 1973), total least squares of the pieces, merging into the map
/// by angle, distance and overlap; corners where ends meet. Keeps the `most` segments of most points.
SegmentMap endPointFit(const std::vector<LaserScan>& scans, std::size_t most, const EndPointFitOptions& options = {});

struct RansacOptions {
  double inlier = 0.05;  ///< greatest distance from the line [m]
  double gap = 0.3;      ///< without points, at which a segment ends [m]
  int trials = 60;       ///< lines tried for a segment
  std::uint64_t seed = 1;
};

/// One segment after the other from all points at once: the line of most points among random ones, total least squares
/// on these, until there are `most`.
SegmentMap ransac(const std::vector<LaserScan>& scans, std::size_t most, const RansacOptions& options = {});

}  // namespace gaussmap::benchmark
