// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Returns the origin to which means are relative when they are stored as floats [m]. It is zero if floats resolve a
/// thousandth of a finest cell everywhere in the map. Otherwise it is a multiple of 1024 m near the middle of the map.
GAUSSMAP_API Vector<3> mapOrigin(const GaussianMap<3>& map);

/// Returns a Gaussian of the map with its mean relative to `origin` [m]. The mean loses no digits far from the origin
/// of the map frame.
GAUSSMAP_API Gaussian<3> gaussianAbout(const Vector<3>& origin, const GaussianMap<3>& map, std::size_t index,
                                       int scale);

}  // namespace gaussmap::detail
