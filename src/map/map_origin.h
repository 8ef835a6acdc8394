// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// What means are written about where they become floats [m]: zero where floats resolve a thousandth of a finest cell
/// everywhere in the map, else a multiple of 1024 m near its middle.
GAUSSMAP_API Vector<3> mapOrigin(const GaussianMap<3>& map);

/// A Gaussian of the map with its mean minus `origin` [m], without a sum that would lose digits far away.
GAUSSMAP_API Gaussian<3> gaussianAbout(const Vector<3>& origin, const GaussianMap<3>& map, std::size_t index,
                                       int scale);

}  // namespace gaussmap::detail
