// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/count_points.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <utility>

#include "common/parallel.h"

namespace gaussmap {

template <int D>
MomentGrid<D> countBlocks(double resolution, std::size_t count,
                          const std::function<void(std::size_t, PointBlock<D>&)>& fill, int threads) {
  constexpr std::size_t kStep = 128 * PointBlock<D>::kCapacity;  // points a task
  MomentGrid<D> all(resolution);
  tbb::enumerable_thread_specific<MomentGrid<D>> partials(resolution);
  parallelFor((count + kStep - 1) / kStep, threads, 1, [&](std::size_t task) {
    MomentGrid<D>& moments = partials.local();
    const std::size_t last = std::min(count, (task + 1) * kStep);
    PointBlock<D> block;
    for (std::size_t first = task * kStep; first < last; first += block.kCapacity) {
      block.size = std::min(last - first, block.kCapacity);
      fill(first, block);
      moments.add(block);
    }
  });
  for (MomentGrid<D>& partial : partials) {
    if (partial.size() > all.size()) std::swap(partial, all);
    all.merge(partial);
  }
  return all;
}

template MomentGrid<2> countBlocks<2>(double, std::size_t, const std::function<void(std::size_t, PointBlock<2>&)>&,
                                      int);
template MomentGrid<3> countBlocks<3>(double, std::size_t, const std::function<void(std::size_t, PointBlock<3>&)>&,
                                      int);

}  // namespace gaussmap
