// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns per point of `from` the distance [m] to the nearest point of `to`: n values in the order of `from`.
/// Both sets are in one frame [m]. The search uses differences of doubles, so it keeps its precision far from the
/// origin. The order of the points does not affect the time; equal points cost only their sorting.
/// `threads`: 0 = all cores.
/// Throws std::invalid_argument if `to` is empty and `from` is not, or if a point is not finite (with its index).
GAUSSMAP_API std::vector<double> nearestDistances(const std::vector<Vector<3>>& from, const std::vector<Vector<3>>& to,
                                                  int threads = 0);

}  // namespace gaussmap::detail
