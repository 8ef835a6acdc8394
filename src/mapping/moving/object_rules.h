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

// The rules for moving objects. MovingPoints applies them to a complete map, and OnlineMapper to a map that grows.
//
// `cells` provides the finest cells of a map. Each cell has an Index below slots(). The members are kDimensions,
// side() [m], key(cell), find(key) (std::nullopt if there is no such cell), evidence(cell), and mean(cell), the mean of
// the cell's points about its centre [m].
namespace gaussmap::detail {

/// Returns the vector from the centre of cell `from` to the centre of cell `to` [m].
template <std::size_t N>
Vector<static_cast<int>(N)> offsetBetween(const std::array<std::int32_t, N>& from,
                                          const std::array<std::int32_t, N>& to, double side) {
  Vector<static_cast<int>(N)> offset;
  for (std::size_t axis = 0; axis < N; ++axis)
    offset[static_cast<Eigen::Index>(axis)] = side * (double(to[axis]) - double(from[axis]));
  return offset;
}

/// Calls body(near) for the existing cells at a distance of `from` to `to` cells from `key`, see forNearKeys().
template <typename Cells, typename Body>
void forNearCells(const Cells& cells, const CellKey<Cells::kDimensions>& key, std::int32_t from, std::int32_t to,
                  const Body& body) {
  forNearKeys(key, from, to, [&](const CellKey<Cells::kDimensions>& near) {
    if (const auto found = cells.find(near)) body(*found);
  });
}

/// Returns all cells of the objects that left the `freed` cells: first the freed cells, then the cells found. A cell
/// belongs to the object of a freed cell under three conditions:
/// - A chain of such cells leads from the freed cell to it. Each is within `link` [m] of the previous one.
/// - The scans that hit it lie between the first and the last scan that hit the freed cell.
/// - The mean of its points is within `reach` [m] of the mean of the points of the freed cell.
template <typename Cells>
std::vector<typename Cells::Index> cellsOfObjects(const Cells& cells, std::vector<typename Cells::Index> freed,
                                                  double link, double reach) {
  using Index = typename Cells::Index;
  std::vector<Index> found = std::move(freed);
  if (found.empty()) return found;
  const double side = cells.side();
  const std::int32_t gap = cellsFor(link, side);
  std::vector<Index> reached_from = found;  // per cell of `found`: its freed cell
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

/// Adds the cell of an object, if it still exists, and the adjacent cells to the shared cells. `shared` maps cells to
/// values with first_scan and last_scan: the first and last scan that may have seen an object in the cell.
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

/// Returns the surface in a cell, about the centre of the cell. It is fitted to the points in the cell and in the rings
/// of cells around it. Rings within `options.reach` [m] are added until the points form a flat surface. Returns
/// std::nullopt if they never do. All lengths of the options are set.
/// `still(cell)` returns the moments of the points that were measured while the object was elsewhere.
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
  const std::int32_t reach = cellsFor(*options.reach, side);
  for (std::int32_t ring = 1; ring <= reach && !surface; ++ring) {
    forNearCells(cells, key, ring, ring, add);
    surface = sums.surface(*options.flatness, *options.extent);
  }
  return surface;
}

}  // namespace gaussmap::detail
