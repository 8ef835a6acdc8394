// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/scans.h"

namespace gaussmap::detail {

/// The one filter of points: drops what is not finite, at the sensor, or farther from it than max_range [m], and
/// transforms the rest into the map frame.
PointCounts acceptPoints(const Pose& pose, ScanFrame frame, double max_range, PointBlock<3>& block);

/// The same for a scan in memory, whose points stay in their order and in the sensor's frame: what is dropped becomes
/// NaN.
PointCounts dropPoints(double max_range, Scan& scan);

}  // namespace gaussmap::detail
