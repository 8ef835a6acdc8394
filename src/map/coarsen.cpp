// SPDX-License-Identifier: BSD-3-Clause
#include "map/coarsen.h"

#include <limits>
#include <stdexcept>
#include <string>

#include "map/map_scale_builder.h"

namespace gaussmap::detail {

template <int D>
Gaussian<D> localGaussian(const MapScale<D>& cells, const Grid<D>& grid, int scale, std::size_t index) {
  if (!cells.gaussians.empty()) return cells.gaussians[index];
  return cells.moments[index].gaussian(grid.side(scale), grid.options().noise);
}

template <int D>
IndexRange gaussiansOf(const MapScale<D>& cells, std::size_t cell) {
  if (cells.first_gaussian.empty()) return {cell, cell + 1};
  return {cells.first_gaussian[cell], cells.first_gaussian[cell + 1]};
}

template <int D>
void gatherUnder(const MapScale<D>& finer, const Grid<D>& grid, int finer_scale, IndexRange cells,
                 std::vector<Gaussian<D>>& out) {
  out.clear();
  if (cells.first == cells.last) return;
  const CellKey<D> parent = grid.ancestor(finer.keys[cells.first], finer_scale, finer_scale + 1);
  for (std::size_t cell = cells.first; cell < cells.last; ++cell) {
    const Vector<D> shift = grid.centreInParent(finer.keys[cell], parent, finer_scale);
    const IndexRange range = gaussiansOf(finer, cell);
    for (std::size_t index = range.first; index < range.last; ++index) {
      out.push_back(localGaussian(finer, grid, finer_scale, index));
      out.back().mean += shift;
    }
  }
}

template <int D>
MapScale<D> coarsen(MapScale<D>& finer, const Grid<D>& grid, int finer_scale) {
  const std::size_t finer_cells = finer.keys.size();
  if (finer.gaussianCount() >= std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("coarsen: scale " + std::to_string(finer_scale) +
                            " has 2^32 - 1 Gaussians or more: use coarser cells");
  MapScaleBuilder<D> coarser;
  finer.parent.resize(finer.gaussianCount());
  std::vector<Gaussian<D>> children;
  for (std::size_t first = 0, last = 0; first < finer_cells; first = last) {
    const CellKey<D> key = grid.ancestor(finer.keys[first], finer_scale, finer_scale + 1);
    for (last = first + 1; last < finer_cells && grid.isParent(key, finer.keys[last]);) ++last;
    const auto cell = static_cast<std::uint32_t>(coarser.cells());
    for (std::size_t i = gaussiansOf(finer, first).first; i < gaussiansOf(finer, last - 1).last; ++i)
      finer.parent[i] = cell;
    gatherUnder(finer, grid, finer_scale, {first, last}, children);
    coarser.addCell(key);
    coarser.addFirstChild(first);
    coarser.addGaussian(merge(children));
  }
  return coarser.take(finer_cells);
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                   \
  template Gaussian<D> localGaussian<D>(const MapScale<D>&, const Grid<D>&, int, std::size_t);                    \
  template IndexRange gaussiansOf<D>(const MapScale<D>&, std::size_t);                                            \
  template void gatherUnder<D>(const MapScale<D>&, const Grid<D>&, int, IndexRange, std::vector<Gaussian<(D)>>&); \
  template MapScale<D> coarsen<D>(MapScale<D>&, const Grid<D>&, int);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::detail
