// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns Gaussian `index` of a scale, with its mean relative to the centre of its cell [m]. If the scale stores
/// moments (finest scale only), the Gaussian is computed from them. Its weight is the number of its points.
template <int D>
Gaussian<D> localGaussian(const MapScale<D>& cells, const Grid<D>& grid, int scale, std::size_t index);

/// Returns the range of the Gaussians of cell `cell`.
template <int D>
GAUSSMAP_API IndexRange gaussiansOf(const MapScale<D>& cells, std::size_t cell);

/// Gathers all Gaussians of cells that have one common parent: G(phi(c)) of Yguel 2009, sec. 5.1. The means are
/// relative to the centre of the parent [m]; this shift is exact, also far from the origin. The function replaces the
/// contents of `out` but keeps its memory.
template <int D>
void gatherUnder(const MapScale<D>& finer, const Grid<D>& grid, int finer_scale, IndexRange cells,
                 std::vector<Gaussian<D>>& out);

/// Returns the next coarser scale with one Gaussian per cell: the moment match (Yguel 2009, eqs. (9), (10)) of all
/// finer Gaussians below the cell. They are summed in their order, so the result depends only on them. Sets keys,
/// first_child and gaussians of the result, and finer.parent. The cells of `finer` must be in key order; they do not
/// change. Throws std::length_error if `finer` has 2^32 - 1 Gaussians or more.
template <int D>
GAUSSMAP_API MapScale<D> coarsen(MapScale<D>& finer, const Grid<D>& grid, int finer_scale);

}  // namespace gaussmap::detail
