// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/map/moment_grid.h"
#include "gaussmap/map/points_view.h"

namespace gaussmap {

/// Counts points [map frame] on `threads` threads (0 = all), which never show in the sums: they are exact. Non-finite
/// points are left out. Throws std::invalid_argument unless the resolution [m] is positive and finite,
/// std::out_of_range, naming the point, if one is too far for 32-bit cells.
MomentGrid<3> countPoints(double resolution, const PointsView& points, int threads = 0);

}  // namespace gaussmap
