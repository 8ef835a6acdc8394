// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// How well a segment map predicts scans that it was not built from. Shares are relative to the beams that returned.
struct HoldOutScore {
  std::size_t beams = 0;        ///< beams that returned; if there are none, all other values are 0
  double within_5cm = 0.0;      ///< cov5, share whose end lies within 5 cm of a segment
  double within_10cm = 0.0;     ///< cov10, the same for 10 cm
  double rms = 0.0;             ///< root mean square of the distances of the ends up to 20 cm [m]
  double predicted_10cm = 0.0;  ///< r10, share whose ray meets its first segment within 10 cm of the measured range
  double blocked_early = 0.0;   ///< viol, share whose ray meets a segment more than 20 cm before the measured range
};

/// Scores a map with scans that it was not built from. Segments stop rays from either side. Scans whose pose is not
/// finite are ignored. Throws std::invalid_argument if an end point of the map is not finite, or if the numbers of
/// bearings and ranges of a scan differ.
GAUSSMAP_API HoldOutScore scoreHoldOut(const SegmentMap& map, const std::vector<LaserScan>& scans);

}  // namespace gaussmap::detail
