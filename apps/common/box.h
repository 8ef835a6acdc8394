// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "gaussmap/map/grid.h"

namespace gaussmap::app {

/// Returns the box of the numbers x0 y0 x1 y1 (all heights) or x0 y0 z0 x1 y1 z1. Throws UsageError that names
/// `option` if there is another count of numbers or the box is empty.
Box<3> boxOf(const std::string& option, const std::vector<double>& numbers);
/// Returns the box for a map: for D = 2, the numbers must be x0 y0 x1 y1.
template <int D>
Box<D> mapBoxOf(const std::string& option, const std::vector<double>& numbers);

/// "[-1.00 -2.00 0.00] .. [1.00 2.00 3.00] m".
template <int D>
std::string textOf(const Box<D>& box);

}  // namespace gaussmap::app
