// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "gaussmap/core/scans.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Which points of scans are used.
struct PointLimits {
  double min_range = 0.0;                                      ///< [m], from the sensor
  double max_range = std::numeric_limits<double>::infinity();  ///< [m], from the sensor
  bool crops = false;                                          ///< true: only points in the box below are used
  Eigen::Vector3d low = Eigen::Vector3d::Zero();               ///< low corner of the box [m, map frame], included
  Eigen::Vector3d high = Eigen::Vector3d::Zero();              ///< high corner of the box [m, map frame], excluded

  /// Returns true if a point [m, map frame] lies in the box, or if there is no box.
  bool isInside(const Eigen::Vector3d& in_map) const {
    return !crops || ((in_map.array() >= low.array()).all() && (in_map.array() < high.array()).all());
  }
  /// Returns true if a point [m, sensor frame] is a return within the range limits.
  bool isInRange(const Eigen::Vector3d& point) const {
    const double range = point.norm();
    return isReturn(point) && range >= min_range && range <= max_range;
  }
};

/// Returns the limits of the options of a reader of scans, which have min_range, max_range and crop.
template <typename Options>
PointLimits limitsOf(const Options& options) {
  PointLimits limits;
  limits.min_range = options.min_range;
  limits.max_range = options.max_range;
  limits.crops = options.crop.has_value();
  if (limits.crops) {
    limits.low = options.crop->low;
    limits.high = options.crop->high;
  }
  return limits;
}

/// Throws std::invalid_argument if a range is negative or the box is empty. The message names the option.
void checkLimits(const PointLimits& limits);

/// Filters the points of a scan, for all algorithms. Drops points that are not finite, at the sensor, or outside the
/// limits, and transforms the rest into the map frame.
GAUSSMAP_API PointCounts acceptPoints(const Pose& pose, ScanFrame frame, const PointLimits& limits,
                                      PointBlock<3>& block);

/// Filters a scan in memory like acceptPoints(). The points stay in their order and in the sensor frame; dropped
/// points become NaN.
GAUSSMAP_API PointCounts dropPoints(const PointLimits& limits, Scan& scan);

}  // namespace gaussmap::detail
