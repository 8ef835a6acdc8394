// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "gaussmap/map/grid.h"

namespace gaussmap::detail {

/// Returns MapScale::first_child for the cells of scale s: the child cells of each cell, in scale s - 1. A cell can
/// have no children. Both lists must be in key order. Throws std::invalid_argument if the parent of a cell is missing;
/// the message names the missing cell.
template <int D>
std::vector<std::uint32_t> childLinks(const std::vector<CellKey<D>>& finer, const std::vector<CellKey<D>>& coarse,
                                      const Grid<D>& grid, int s) {
  std::vector<std::uint32_t> first_child = {0};
  std::size_t child = 0;
  for (const CellKey<D>& key : coarse) {
    while (child < finer.size() && grid.ancestor(finer[child], s - 1, s) == key) ++child;
    first_child.push_back(static_cast<std::uint32_t>(child));
  }
  if (child < finer.size())
    throw std::invalid_argument("cell " + toString<D>(grid.ancestor(finer[child], s - 1, s)) + " of scale " +
                                std::to_string(s) + " is missing");
  return first_child;
}

}  // namespace gaussmap::detail
