// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/moment_grid.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <utility>

#include "core/function_clones.h"
#include "core/parallel.h"

namespace gaussmap {
using namespace detail;

namespace {

/// Copies the points into one array per axis. If the compiler knows the stride, it can load and transpose several
/// points at once.
template <std::size_t kStride>
inline void spread(const float* points, std::size_t stride, PointBlock<3>& block) {
  if (kStride > 0) stride = kStride;
  for (std::size_t i = 0; i < block.size; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      block.coordinate[axis][i] = static_cast<double>(points[i * stride + axis]);
}

GAUSSMAP_CLONES void fill(const PointsView& points, std::size_t first, PointBlock<3>& block) {
  if (points.stride == 4)
    spread<4>(points[first], points.stride, block);
  else
    spread<0>(points[first], points.stride, block);
}

}  // namespace

MomentGrid<3> countPoints(double resolution, const PointsView& points, int threads) {
  constexpr std::size_t kTask = 128 * PointBlock<3>::kCapacity;
  MomentGrid<3> all(resolution);
  tbb::enumerable_thread_specific<MomentGrid<3>> partials(resolution);
  parallelFor((points.count + kTask - 1) / kTask, threads, 1, [&](std::size_t task) {
    MomentGrid<3>& moments = partials.local();
    const std::size_t last = std::min(points.count, (task + 1) * kTask);
    PointBlock<3> block;
    for (std::size_t first = task * kTask; first < last; first += block.kCapacity) {
      block.size = std::min(last - first, block.kCapacity);
      fill(points, first, block);
      moments.add(block);
    }
  });
  for (MomentGrid<3>& partial : partials) {
    if (partial.size() > all.size()) std::swap(partial, all);
    all.merge(partial, threads);
  }
  return all;
}

}  // namespace gaussmap
