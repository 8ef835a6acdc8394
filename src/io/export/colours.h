// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

// Colours of Gaussians, for the exports and the viewer.
namespace gaussmap::detail {

using Colour = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// Returns a colour of the perceptually uniform scale Viridis (van der Walt & Smith 2015): dark for 0 and less, bright
/// for 1 and more.
GAUSSMAP_API Colour viridis(double place);

/// Returns the colour of a surface with this normal: sand if it is horizontal, blue if it faces along x, red if it
/// faces along y. Other normals mix the three colours by the squares of their components. The sign does not matter.
GAUSSMAP_API Colour normalColour(const Vector<3>& normal);

/// Returns the values at the two ends of a colour scale: the 1 % and the 99 % quantile, so that a few outliers do not
/// use up the colours. If both are equal, the ends are 0.5 below and above. Values that are not finite are ignored; the
/// result is 0 and 1 if no value is finite.
GAUSSMAP_API std::pair<double, double> colourRange(std::vector<double> values);

/// Returns the values at the two ends of a logarithmic colour scale: the 1 % and the 99 % quantile of the positive
/// values, but at most a factor of 10,000 apart. If both are equal, the ends are a factor of 2 below and above. Values
/// that are not finite are ignored; the result is 0.1 and 10 if no value is positive.
GAUSSMAP_API std::pair<double, double> logColourRange(std::vector<double> values);

}  // namespace gaussmap::detail
