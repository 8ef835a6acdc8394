// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// The map of those cells for which keep[s][cell] is true, unchanged. All coarsest cells must be kept, and no cell
/// under one that is not.
template <int D>
GAUSSMAP_API GaussianMap<D> keepCells(const GaussianMap<D>& map, const std::vector<std::vector<char>>& keep);

}  // namespace gaussmap::detail
