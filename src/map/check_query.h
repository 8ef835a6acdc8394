// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <stdexcept>
#include <string>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// Limit of a search that accepts means at any distance [m].
inline constexpr double kAnyDistance = std::numeric_limits<double>::infinity();

/// Throws std::out_of_range if a map does not have a scale.
template <int D>
void checkScale(const GaussianMap<D>& map, int scale) {
  if (scale < 0 || scale >= map.scales())
    throw std::out_of_range("scale " + std::to_string(scale) + ": the number of scales of the map is " +
                            std::to_string(map.scales()));
}

/// Throws std::out_of_range if a point is not finite or out of the grid's range.
template <int D>
void checkQuery(const Grid<D>& grid, const Vector<D>& point) {
  static_cast<void>(grid.keyOf(point));
}

/// Throws std::invalid_argument if a number of neighbours is negative.
inline void checkCount(int k) {
  if (k < 0) throw std::invalid_argument("k = " + std::to_string(k) + ": expected a number of Gaussians, at least 0");
}

/// Throws std::invalid_argument if a radius [m] is negative or NaN.
inline void checkRadius(double radius) {
  if (!(radius >= 0.0))
    throw std::invalid_argument("radius = " + std::to_string(radius) + ": expected a number of metres, at least 0");
}

}  // namespace gaussmap::detail
