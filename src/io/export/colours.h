// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "gaussmap/core/gaussian.h"

// Colours that Gaussians are exported and shown in.
namespace gaussmap::detail {

using Colour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// Viridis (van der Walt & Smith 2015): equal differences look equal, dark at 0, bright at 1 and beyond.
Colour viridis(double place);

/// What lies flat is sand, what faces along x blue, along y red; in between they mix by the squares of the normal's
/// parts. The sign of the unit normal does not matter.
Colour normalColour(const Vector<3>& normal);

/// What the ends of a colour scale stand for: the 1 % and the 99 % quantile, so that a few far ones do not take the
/// colours from all others; one apart if they are equal. Values that are not finite are left out; 0 and 1 if none is.
std::pair<double, double> colourRange(std::vector<double> values);

}  // namespace gaussmap::detail
