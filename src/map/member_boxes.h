// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/grid.h"

namespace gaussmap::detail {

/// Returns one box per Gaussian of a scale [m, map frame]: the bounds of the finest cells that the Gaussian represents.
/// No point of the Gaussian lies outside its box. The boxes follow from the links, so a map file does not store them.
/// The tails of a Gaussian reach beyond its object; the box reaches at most one finest cell beyond it. At the finest
/// scale the boxes are the cells. A Gaussian without children (its detail was deleted, or loadPcd() guessed the links)
/// has its cell as box, and the boxes of the coarser scales contain this cell.
template <int D>
std::vector<Box<D>> memberBoxes(const GaussianMap<D>& map, int scale);

}  // namespace gaussmap::detail
