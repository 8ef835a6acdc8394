// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::refinement {

/// The plain way to spend `most` Gaussians: one in each cell of a grid just fine enough. The side is found by bisection
/// down from `widest` [m]; the map's scale 1 has it, its scale 0 cells of about `finest` [m], a whole number along a
/// side, so that its Gaussians are made and sampled like those of other maps.
/// Throws std::invalid_argument if even cells of `widest` are more than `most`.
GaussianMap<3> uniformGrid(const std::vector<Vector<3>>& points, std::size_t most, double widest, double finest);

}  // namespace gaussmap::refinement
