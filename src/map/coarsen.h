// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Gaussian `index` of a scale, its mean about the centre of its cell [m]: stored, or made from the moments
/// (finest scale). Its weight is the number of its points.
template <int D>
Gaussian<D> localGaussian(const MapScale<D>& cells, const Grid<D>& grid, int scale, std::size_t index);

/// The Gaussians that cell `cell` of a scale holds.
template <int D>
GAUSSMAP_API IndexRange gaussiansOf(const MapScale<D>& cells, std::size_t cell);

/// All Gaussians of some cells with one common parent, means about the parent's centre [m] (the shift is exact
/// wherever the cells are): G(phi(c)) of Yguel 2009, sec. 5.1. Replaces the contents of `out`, keeps its memory.
template <int D>
void gatherUnder(const MapScale<D>& finer, const Grid<D>& grid, int finer_scale, IndexRange cells,
                 std::vector<Gaussian<D>>& out);

/// The next coarser scale with one Gaussian per cell: the moment match (Yguel 2009, eqs. (9), (10)) of all finer
/// Gaussians under the cell, summed in their order, so that it depends on nothing but them. Sets keys, first_child,
/// gaussians, and finer.parent. The cells of `finer` stand in key order and stay as they are.
/// Throws std::length_error at 2^32 finer cells or Gaussians and beyond.
template <int D>
GAUSSMAP_API MapScale<D> coarsen(MapScale<D>& finer, const Grid<D>& grid, int finer_scale);

}  // namespace gaussmap::detail
