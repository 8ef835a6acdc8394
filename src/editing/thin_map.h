// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// The map without the cells that keep[s][cell] refuses; what stays is as it was. All coarsest cells stay; where a cell
/// goes, so do all cells under it.
template <int D>
GaussianMap<D> thinMap(const GaussianMap<D>& map, const std::vector<std::vector<char>>& keep);

}  // namespace gaussmap::detail
