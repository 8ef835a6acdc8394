// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Adds points to a part of a map that is closed: it holds everything under its coarsest cells. Finest sums add
/// exactly. Coarse cells with new points under them are rebuilt from all that is under them, by agglomeration as in
/// refine(); all other cells stay as they are. With `occupancy`, finest cells keep their log-odds, new ones have
/// kMaxOccupancy, and rebuilt coarse cells follow.
/// `maxGaussians(scale, cells)` = how many Gaussians a coarse scale of the part may have if it has so many cells. The
/// rebuilt cells share what the other cells leave of them, at least one each.
template <int D>
GAUSSMAP_API GaussianMap<D> updatePart(const GaussianMap<D>& old, const MomentGrid<D>& added, bool occupancy,
                                       const RefineOptions& options,
                                       const std::function<std::size_t(int scale, std::size_t cells)>& maxGaussians);

}  // namespace gaussmap::detail
