// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "gaussmap/core/cell_moments.h"
#include "gaussmap/core/scans.h"

namespace gaussmap::detail {

/// The points of a block, cut into runs of one cell each.
template <int D>
struct Runs {
  const std::int32_t (*offset)[PointBlock<D>::kCapacity];  ///< D arrays, from the centre of the point's cell [steps]
  const std::uint32_t* starts;                             ///< first point of each run, and the end of the last
  std::size_t count;
  CellMoments<D>* const* cells;  ///< of each run; runs may share a cell
};

/// Adds every point to the moments of its run's cell. The innermost loop of map building: on processors with AVX2
/// the ten sums of a cell take three additions.
void addRuns(const Runs<2>& runs);
void addRuns(const Runs<3>& runs);

/// The same in plain C++, for every other processor and for the tests.
template <int D>
void addRunsPlainly(const Runs<D>& runs) {
  for (std::size_t run = 0; run < runs.count; ++run)
    for (std::size_t i = runs.starts[run]; i < runs.starts[run + 1]; ++i) {
      typename CellMoments<D>::Offset offset;
      for (std::size_t axis = 0; axis < D; ++axis) offset[axis] = runs.offset[axis][i];
      runs.cells[run]->add(offset);
    }
}

}  // namespace gaussmap::detail
