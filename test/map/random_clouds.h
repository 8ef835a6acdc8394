// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::test {

/// Returns points like those of real maps: clusters of all sizes, some of them flat, and some single points, within
/// about 4 m of the origin.
template <int D>
std::vector<Vector<D>> randomCloud(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vector<D>> points;
  while (points.size() < count) {
    Vector<D> centre, spread;
    for (int axis = 0; axis < D; ++axis) {
      centre(axis) = 4.0 * random.uniform() - 2.0;
      spread(axis) = random.uniform() * random.uniform() * random.uniform();
    }
    const std::size_t size = 1 + random.below(200);
    for (std::size_t i = 0; i < size && points.size() < count; ++i) {
      Vector<D> point = centre;
      for (int axis = 0; axis < D; ++axis) point(axis) += spread(axis) * (2.0 * random.uniform() - 1.0);
      points.push_back(point);
    }
  }
  return points;
}

}  // namespace gaussmap::test
