// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/scans.h"

namespace gaussmap::detail {

/// Filters the points of a scan, for all algorithms. Drops points that are not finite, at the sensor, or farther from
/// it than max_range [m], and transforms the rest into the map frame.
PointCounts acceptPoints(const Pose& pose, ScanFrame frame, double max_range, PointBlock<3>& block);

/// Filters a scan in memory like acceptPoints(). The points stay in their order and in the sensor frame; dropped
/// points become NaN.
PointCounts dropPoints(double max_range, Scan& scan);

}  // namespace gaussmap::detail
