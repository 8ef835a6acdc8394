// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

#include "gaussmap/core/cell_moments.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/map/grid.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Sorts points into the cells of the finest scale and holds the exact moments of every cell.
///
/// The hash table uses open addressing with 8-byte slots. The cells lie in chunks of fixed size, so a cell never moves
/// in memory and has no allocation of its own. A moved-from grid can only be destroyed or assigned to.
template <int D>
class GAUSSMAP_API MomentGrid {
 public:
  /// A cell with its moments. The alignment keeps a cell within two cache lines.
  struct alignas(32) Cell {
    CellKey<D> key;          ///< integer coordinates
    CellMoments<D> moments;  ///< exact sums over the points of the cell
  };
  static_assert(sizeof(Cell) <= 96, "a finest cell must fit into one and a half cache lines");

  /// Makes an empty grid with cells of side `resolution` [m]. Throws std::invalid_argument unless the resolution is
  /// positive and finite.
  explicit MomentGrid(double resolution);

  /// Returns the side of the cells [m].
  double resolution() const { return resolution_; }
  /// Returns the number of occupied cells.
  std::size_t size() const { return size_; }
  /// Returns true if no cell is occupied.
  bool empty() const { return size_ == 0; }
  /// Returns occupied cell `index`. Cells are in the order in which they received their first point.
  const Cell& operator[](std::size_t index) const { return chunks_[index / kChunk][index % kChunk]; }
  /// Returns the moments of a cell, or nullptr if the cell has no point.
  const CellMoments<D>* find(const CellKey<D>& key) const;
  /// Returns the number of points added so far.
  std::int64_t pointCount() const { return point_count_; }

  /// Adds the finite points of a block [m, map frame] to their cells and returns the number of these points.
  ///
  /// Throws std::out_of_range if a point lies beyond the range of 32-bit cell indices; the message gives the point.
  /// Throws std::length_error if a cell would hold more points than CellMoments::kMaxPoints. In both cases no point of
  /// the block is added.
  std::size_t add(const PointBlock<D>& block);

  /// Adds the finite points among `count` points [m, map frame] to their cells and returns their number. `point(i)`
  /// returns point i as anything that can be indexed by axis ([0], [1], ...). The points are added in blocks. Throws
  /// like add() for a block; the blocks before it remain added.
  template <typename PointAt>
  std::size_t addPoints(std::size_t count, PointAt&& point) {
    PointBlock<D> block;
    std::size_t added = 0;
    for (std::size_t first = 0; first < count; first += block.kCapacity) {
      block.size = count - first < block.kCapacity ? count - first : block.kCapacity;
      for (std::size_t i = 0; i < block.size; ++i) {
        const auto& p = point(first + i);
        for (int axis = 0; axis < D; ++axis) block.coordinate[axis][i] = static_cast<double>(p[axis]);
      }
      added += add(block);
    }
    return added;
  }
  /// Adds the finite points of a list [m, map frame] to their cells and returns their number. Throws like the other
  /// addPoints().
  std::size_t addPoints(const std::vector<Vector<D>>& points) {
    return addPoints(points.size(), [&](std::size_t i) -> const Vector<D>& { return points[i]; });
  }

  /// Adds moments to one cell. Throws std::length_error if the cell would hold too many points.
  void add(const CellKey<D>& key, const CellMoments<D>& moments);

  /// Adds all cells of another grid of the same resolution. `threads`: 0 = all cores.
  ///
  /// The sums are exact, so any order of merging gives the same sums. Throws std::invalid_argument if the resolutions
  /// differ, and std::length_error if a cell would hold too many points.
  void merge(const MomentGrid& other, int threads = 0);

  /// Returns the bytes in use: the hash table and the occupied part of the chunks.
  std::size_t memoryBytes() const;

 private:
  struct Slot {
    std::uint32_t hash;   // hash of the key; most comparisons need only this and do not read the cell
    std::uint32_t index;  // index of the cell, or kEmpty
  };
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  static constexpr std::size_t kChunk = 65536;  // cells per chunk; a chunk fills whole huge pages
  static constexpr std::uint32_t kEmpty = 0xFFFFFFFFu;

  Cell& cell(std::uint32_t index) { return chunks_[index / kChunk][index % kChunk]; }
  /// Returns the index of the first cell with this hash, or kEmpty. Another key can have the same hash, so the caller
  /// compares the key.
  std::uint32_t candidate(std::uint32_t hash) const;
  static void prefetch(const Cell& cell);
  std::uint32_t indexOf(const CellKey<D>& key, std::uint32_t hash) const;  // kEmpty if the grid has no such cell
  Cell& findOrInsert(const CellKey<D>& key, std::uint32_t hash);
  /// Allocates chunks and slots for `cells` cells in total.
  void reserve(std::size_t cells);
  /// Enters a new cell into the hash table. The caller has constructed the cell directly after the last cell.
  void enter(std::uint32_t hash);
  /// Enlarges the hash table to `slot_count` slots.
  void widen(std::size_t slot_count);

  double resolution_;
  std::size_t size_ = 0;
  std::int64_t point_count_ = 0;
  std::size_t slot_count_ = 0;  // a power of two
  std::vector<std::unique_ptr<Cell[], Free>> chunks_;
  std::unique_ptr<Slot[], Free> slots_;
};

/// Sorts points [m, map frame] into the cells of a new grid. `threads`: 0 = all cores.
///
/// Non-finite points are ignored. Throws std::invalid_argument unless the resolution [m] is positive and finite, and
/// std::out_of_range if a point lies beyond the range of 32-bit cell indices; the message gives the point.
GAUSSMAP_API MomentGrid<3> countPoints(double resolution, const PointsView& points, int threads = 0);

}  // namespace gaussmap
