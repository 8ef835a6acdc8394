// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {

/// Returns points on a floor, two walls at right angles and a pole, with a roughness of 1 cm, about 6 m wide. All
/// coordinates have both signs.
inline std::vector<Vector<3>> roomPoints(Random& random, std::size_t n) {
  std::vector<Vector<3>> points;
  for (std::size_t i = 0; i < n; ++i) {
    const double a = 6.0 * random.uniform() - 3.0, b = 2.5 * random.uniform() - 1.0;
    Vector<3> point;
    switch (i % 4) {
      case 0:
        point = {a, 6.0 * random.uniform() - 3.0, -1.0};
        break;
      case 1:
        point = {-3.0, a, b};
        break;
      case 2:
        point = {a, 3.0, b};
        break;
      default:
        point = {1.3, -0.7, b};
    }
    for (int axis = 0; axis < 3; ++axis) point(axis) += 0.01 * random.normal();
    points.push_back(point);
  }
  return points;
}

}  // namespace gaussmap
