// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>

#include "gaussmap/map/moment_grid.h"

namespace gaussmap {

/// Counts `count` points on `threads` threads (0 = all), which never show in the sums: they are exact.
/// fill(first, block) writes the points first, first + 1 ... [m, map frame], `block.size` of them; it is called from
/// several threads at once. Throws as MomentGrid; std::out_of_range if a point is too far for 32-bit cells.
template <int D>
MomentGrid<D> countBlocks(double resolution, std::size_t count,
                          const std::function<void(std::size_t, PointBlock<D>&)>& fill, int threads = 0);

/// The same with point(i) giving anything indexable by axis ([0], [1], ...).
template <int D, typename PointAt>
MomentGrid<D> countPoints(double resolution, std::size_t count, const PointAt& point, int threads = 0) {
  return countBlocks<D>(
      resolution, count,
      [&](std::size_t first, PointBlock<D>& block) {
        for (std::size_t i = 0; i < block.size; ++i) {
          const auto& p = point(first + i);
          for (int axis = 0; axis < D; ++axis) block.coordinate[axis][i] = static_cast<double>(p[axis]);
        }
      },
      threads);
}

}  // namespace gaussmap
