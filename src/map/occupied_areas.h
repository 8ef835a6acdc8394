// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "map/coarsen.h"

namespace gaussmap::detail {

/// Returns the number of occupied finest cells per Gaussian of the finest scale. Gaussians in the same cell get equal
/// shares of it.
template <int D>
std::vector<double> finestAreas(const MapScale<D>& finest) {
  std::vector<double> areas;
  areas.reserve(finest.gaussianCount());
  for (std::size_t cell = 0; cell < finest.keys.size(); ++cell) {
    const std::size_t count = gaussiansOf(finest, cell).size();
    areas.insert(areas.end(), count, 1.0 / static_cast<double>(count));
  }
  return areas;
}

/// Returns the number of occupied finest cells for `count` Gaussians of the coarser scale: the sums over their
/// children. It is 0 for a Gaussian without children.
template <int D>
std::vector<double> coarserAreas(const MapScale<D>& finer, const std::vector<double>& finer_areas, std::size_t count) {
  std::vector<double> areas(count, 0.0);
  for (std::size_t i = 0; i < finer_areas.size(); ++i) areas[finer.parent[i]] += finer_areas[i];
  return areas;
}

/// Returns the number of occupied finest cells per Gaussian of scale s >= 1. A leaf of a compressed map has no finer
/// cells. It counts as a surface straight through the cell, and its Gaussians get equal shares of it. A Gaussian
/// without children in another cell counts as one finest cell.
template <int D>
std::vector<double> areasOf(const MapScale<D>& scale, const Grid<D>& grid, int s, const MapScale<D>& finer,
                            const std::vector<double>& finer_areas) {
  std::vector<double> areas = coarserAreas(finer, finer_areas, scale.gaussianCount());
  for (double& area : areas)
    if (area == 0.0) area = 1.0;
  const double across = std::pow(static_cast<double>(grid.cellsAlongSide(s)), D - 1);
  for (std::size_t cell = 0; cell < scale.keys.size(); ++cell) {
    if (scale.first_child[cell] != scale.first_child[cell + 1]) continue;
    const IndexRange range = gaussiansOf(scale, cell);
    for (std::size_t i = range.first; i < range.last; ++i) areas[i] = across / static_cast<double>(range.size());
  }
  return areas;
}

}  // namespace gaussmap::detail
