// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "gaussmap/map/grid.h"
#include "gaussmap/sensor/visibility.h"
#include "map/neighbour_keys.h"
#include "mapping/moving/surface.h"

// The rules for moving objects, for a complete map (MovingPoints) and for a map that grows (OnlineMapper).
//
// `cells` gives the finest cells of a map, each named by an Index below slots(): kDimensions, side() [m], key(cell),
// find(key) (nullopt if there is no such cell), evidence(cell), mean(cell) of its points about the cell's centre [m].
namespace gaussmap::detail {

/// From the centre of cell `from` to that of cell `to` [m].
template <std::size_t N>
Vector<static_cast<int>(N)> offsetBetween(const std::array<std::int32_t, N>& from,
                                          const std::array<std::int32_t, N>& to, double side) {
  Vector<static_cast<int>(N)> offset;
  for (std::size_t axis = 0; axis < N; ++axis)
    offset[static_cast<Eigen::Index>(axis)] = side * (double(to[axis]) - double(from[axis]));
  return offset;
}

/// Calls body(near) for the cells that differ from `key` by `from` to `to` cells, see forNearKeys().
template <typename Cells, typename Body>
void forNearCells(const Cells& cells, const CellKey<Cells::kDimensions>& key, std::int32_t from, std::int32_t to,
                  const Body& body) {
  forNearKeys(key, from, to, [&](const CellKey<Cells::kDimensions>& near) {
    if (const auto found = cells.find(near)) body(*found);
  });
}

/// All cells of the objects that left the `freed` cells: the freed ones, then those found. A cell belongs to the object
/// of a freed cell if a chain of cells, each within `link` of the one before [m], leads to it, the scans saw it only
/// while they saw the freed cell, and its points are within `reach` of those of the freed cell [m].
template <typename Cells>
std::vector<typename Cells::Index> cellsOfObjects(const Cells& cells, std::vector<typename Cells::Index> freed,
                                                  double link, double reach) {
  using Index = typename Cells::Index;
  std::vector<Index> found = std::move(freed);
  if (found.empty()) return found;
  const double side = cells.side();
  const std::int32_t gap = cellsFor(link, side);
  std::vector<Index> reached_from = found;  // the freed cell of each
  std::vector<bool> taken(cells.slots());
  for (const Index cell : found) taken[cell] = true;
  for (std::size_t next = 0; next < found.size(); ++next) {
    const Index seed = reached_from[next];
    const Evidence object = cells.evidence(seed);
    forNearCells(cells, cells.key(found[next]), 1, gap, [&](Index near) {
      if (taken[near]) return;
      const Evidence& evidence = cells.evidence(near);
      if (evidence.hits == 0 || evidence.first_hit < object.first_hit || evidence.last_hit > object.last_hit) return;
      Vector<Cells::kDimensions> apart = cells.mean(near) - cells.mean(seed);
      apart += offsetBetween(cells.key(seed), cells.key(near), side);
      if (apart.norm() > reach) return;
      taken[near] = true;
      found.push_back(near);
      reached_from.push_back(seed);
    });
  }
  return found;
}

/// Notes the cell of an object, if it still exists, and the cells beside it as shared. `shared` maps cells to values
/// with first_scan and last_scan: the scans that may have seen an object in the cell.
template <typename Cells, typename Shared>
void noteSharedCells(const Cells& cells, const CellKey<Cells::kDimensions>& key,
                     const typename Shared::mapped_type& object, Shared& shared) {
  const auto widen = [&](typename Cells::Index cell) {
    auto& entry = shared.try_emplace(cell, object).first->second;
    entry.first_scan = std::min(entry.first_scan, object.first_scan);
    entry.last_scan = std::max(entry.last_scan, object.last_scan);
  };
  if (const auto cell = cells.find(key)) widen(*cell);
  forNearCells(cells, key, 1, 1, widen);
}

/// The surface in a cell, about its centre, from the points there and around: the nearest cells that make a flat piece.
/// `still(cell)` gives the moments of the points that were measured while the object was elsewhere.
template <typename Cells, typename Still>
std::optional<Surface<Cells::kDimensions>> surfaceAt(const Cells& cells, typename Cells::Index cell, const Still& still,
                                                     const SharedCellOptions& options) {
  constexpr int D = Cells::kDimensions;
  const double side = cells.side();
  const CellKey<D> key = cells.key(cell);
  SurfaceSums<D> sums;
  const auto add = [&](typename Cells::Index near) {
    sums.add(still(near), side, offsetBetween(key, cells.key(near), side));
  };
  add(cell);
  std::optional<Surface<D>> surface;
  const std::int32_t reach = cellsFor(options.reach, side);
  for (std::int32_t ring = 1; ring <= reach && !surface; ++ring) {
    forNearCells(cells, key, ring, ring, add);
    surface = sums.surface(options.flatness);
  }
  return surface;
}

}  // namespace gaussmap::detail
