// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/grid.h"

namespace gaussmap::detail {

/// For every Gaussian of a scale the box of the finest cells that it stands for [m, map frame]: no point behind it
/// lies outside. Follows the links, so it costs the file nothing. A Gaussian's tails reach past its object, this box
/// does not reach further than a finest cell. Finest scale: the cells themselves. A Gaussian to which no finer one is
/// linked (its detail was deleted, or links were guessed by loadPcd()) has its cell, here and for coarser scales.
template <int D>
std::vector<Box<D>> memberBoxes(const GaussianMap<D>& map, int scale);

}  // namespace gaussmap::detail
