// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_map.h"

// Common methods that solve the task of SegmentFitter.
namespace gaussmap::benchmark {

struct EndPointFitOptions {
  double threshold = 0.08;  ///< maximum distance of a point from the chord [m]
  double gap = 0.5;         ///< beyond this distance, neighbouring beams are of different pieces [m]
  std::size_t points = 5;   ///< minimum number per piece
  double merge = 0.1;       ///< maximum distance of a piece's ends from the line that it joins [m]
  double merge_deg = 10.0;  ///< maximum angle between both [degree]
  double merge_gap = 0.3;   ///< maximum gap between both along the line [m]
};

/// Fits line segments by the iterative end-point fit of every scan (Duda and Hart 1973) and total least squares of the
/// pieces. Pieces are merged into the map by angle, distance and overlap. Ends that meet become corners. Keeps the
/// `most` segments with the largest numbers of points.
SegmentMap endPointFit(const std::vector<LaserScan>& scans, std::size_t most, const EndPointFitOptions& options = {});

struct RansacOptions {
  double inlier = 0.05;  ///< maximum distance from the line [m]
  double gap = 0.3;      ///< a segment ends at a gap of this length without points [m]
  int trials = 60;       ///< lines tried per segment
  std::uint64_t seed = 1;
};

/// Finds one segment after the other in all points at once, until there are `most`. Takes the line with the largest
/// number of points among random lines and fits these points by total least squares.
SegmentMap ransac(const std::vector<LaserScan>& scans, std::size_t most, const RansacOptions& options = {});

}  // namespace gaussmap::benchmark
