// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Adds points to a part of a map. The part must be closed: it holds all finer cells under its coarsest cells. The
/// moments of the finest cells are added exactly. A coarse cell with new points under it is rebuilt from all finer
/// Gaussians under it, by agglomeration as in refine(). All other cells do not change. With `occupancy`, finest cells
/// keep their log-odds, new finest cells get kMaxOccupancy, and rebuilt coarse cells inherit from their children.
/// `maxGaussians(scale, cells)` returns the maximum number of Gaussians of a coarse scale of the part with that number
/// of cells. The unchanged cells keep their Gaussians, and the rebuilt cells share the rest, at least one per cell.
template <int D>
GAUSSMAP_API GaussianMap<D> updatePart(const GaussianMap<D>& old, const MomentGrid<D>& added, bool occupancy,
                                       const RefineOptions& options,
                                       const std::function<std::size_t(int scale, std::size_t cells)>& maxGaussians);

}  // namespace gaussmap::detail
