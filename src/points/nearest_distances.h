// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// For every point of `from` the distance [m] to the nearest point of `to`, n values in the order of `from`.
/// Both sets in one frame [m]. The search works on differences of doubles, so that clouds far from the origin lose
/// nothing. The order of the points does not matter, for the time neither; equal points cost only their sorting.
/// `threads` = 0: all; the result is the same to the last bit for any number.
/// Throws std::invalid_argument if `to` is empty while `from` is not, or if a point is not finite (naming its index).
std::vector<double> nearestDistances(const std::vector<Vector<3>>& from, const std::vector<Vector<3>>& to,
                                     int threads = 0);

}  // namespace gaussmap::detail
