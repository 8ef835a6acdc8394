// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::refinement {

/// Returns a map with `most` Gaussians at most, in the simplest way: one per cell of a grid. The side of its cells is
/// found by bisection down from `widest` [m], so that the grid is as fine as possible. Scale 1 of the map has this
/// side. Scale 0 has cells of about `finest` [m], a whole number of them along a side. So the Gaussians are made and
/// sampled like those of other maps. Throws std::invalid_argument if cells of side `widest` are already more than
/// `most`.
GaussianMap<3> uniformGrid(const std::vector<Vector<3>>& points, std::size_t most, double widest, double finest);

}  // namespace gaussmap::refinement
