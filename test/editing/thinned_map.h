// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "editing/keep_cells.h"

namespace gaussmap::test {
using namespace detail;

/// Returns a compressed map with leaves at every scale. It deletes everything below every third cell of the coarsest
/// scale and below every second cell of the other scales.
template <int D>
GaussianMap<D> thinned(const GaussianMap<D>& map) {
  std::vector<std::vector<char>> keep(static_cast<std::size_t>(map.scales()));
  keep.back().assign(map.cellCount(map.scales() - 1), true);
  for (int s = map.scales() - 1; s > 0; --s) {
    const std::vector<char>& kept = keep[static_cast<std::size_t>(s)];
    std::vector<char>& finer = keep[static_cast<std::size_t>(s) - 1];
    const std::size_t nth = s + 1 == map.scales() ? 3 : 2;
    for (std::size_t cell = 0; cell < kept.size(); ++cell)
      finer.insert(finer.end(), map.childCells(cell, s).size(), kept[cell] && cell % nth != 0);
  }
  return keepCells(map, keep);
}

}  // namespace gaussmap::test
