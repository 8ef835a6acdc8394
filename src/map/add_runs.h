// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "gaussmap/core/cell_moments.h"
#include "gaussmap/core/scans.h"

namespace gaussmap::detail {

/// The points of a block, cut into runs. All points of a run lie in the same cell.
template <int D>
struct Runs {
  const std::int32_t (*offset)[PointBlock<D>::kCapacity];  ///< D arrays: offset from the centre of the cell [steps]
  const std::uint32_t* starts;                             ///< first point of each run, and the end of the last
  std::size_t count;
  CellMoments<D>* const* cells;  ///< the cell of each run; runs can share a cell
};

/// Adds every point to the moments of its cell. This is the innermost loop of map building. On processors with AVX2,
/// three vector additions update the ten sums of a cell.
void addRuns(const Runs<2>& runs);
void addRuns(const Runs<3>& runs);

/// Does the same as addRuns() in plain C++, for all other processors and for the tests.
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
