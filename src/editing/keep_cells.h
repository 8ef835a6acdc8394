// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns the map of the cells for which keep[s][cell] is true; these cells do not change. All coarsest cells must be
/// kept. If a cell is not kept, no cell under it may be kept.
template <int D>
GAUSSMAP_API GaussianMap<D> keepCells(const GaussianMap<D>& map, const std::vector<std::vector<char>>& keep);

}  // namespace gaussmap::detail
