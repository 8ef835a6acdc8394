// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// A coarse Gaussian is as occupied as what is most so under it: it goes when all of it has gone (Yguel 2009, sec.
/// 5.3). Sets the log-odds of `coarse` from those of the next finer scale; does nothing if that one has none.
template <int D>
void inheritOccupancy(const MapScale<D>& finer, MapScale<D>& coarse);

/// The map with these log-odds at its finest scale (one per Gaussian) and what follows from them above. A coarse
/// Gaussian with nothing under it keeps what the map said of it.
/// Throws std::invalid_argument unless there is a finite one for every Gaussian of the finest scale.
template <int D>
GaussianMap<D> withOccupancy(const GaussianMap<D>& map, const std::vector<float>& log_odds);

}  // namespace gaussmap::detail
