// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"

namespace gaussmap {

/// Cells of moments -> the whole map: sorts them into key order, then makes every coarser scale from the finer one
/// by moment matching (Yguel 2009, eqs. (9), (10)), one Gaussian per cell. Points are not touched again.
/// Throws std::invalid_argument if the grid's resolution is not the options'.
template <int D>
GaussianMap<D> build(const MomentGrid<D>& grid, const MapOptions& options);

/// Points [m, map frame] -> map. Non-finite points are left out. Throws std::out_of_range, naming the point, if one
/// is too far for 32-bit cells.
template <int D>
GaussianMap<D> build(const std::vector<Vector<D>>& points, const MapOptions& options);

/// The coarser scales for a finest scale that is given as plain cells of Gaussians (an imported map), in any order.
/// Sets keys, Gaussians and links. Throws std::invalid_argument, saying what, if the cells are no scale.
template <int D>
GaussianMap<D> build(const MapScale<D>& finest, const MapOptions& options);

}  // namespace gaussmap
