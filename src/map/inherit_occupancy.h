// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// Sets the log-odds of `coarse` from those of the next finer scale (Yguel 2009, sec. 5.3). The log-odds of a coarse
/// Gaussian are the maximum over its children, so it is removed only when all children are. A Gaussian without children
/// keeps its log-odds, or gets kMaxOccupancy if `coarse` has none. Does nothing if the finer scale has no log-odds.
template <int D>
void inheritOccupancy(const MapScale<D>& finer, MapScale<D>& coarse);

/// Returns the map with these log-odds at its finest scale (one per Gaussian). The log-odds of the coarser scales
/// follow from them. A coarse Gaussian without children keeps its log-odds. Throws std::invalid_argument unless there
/// is one finite value per Gaussian of the finest scale.
template <int D>
GaussianMap<D> withOccupancy(const GaussianMap<D>& map, const std::vector<float>& log_odds);

}  // namespace gaussmap::detail
