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

/// The finest scale while it grows: points in, exact moments per cell out.
/// Open addressing over 8-byte slots, cells in fixed chunks: nothing is allocated per cell and a cell never moves. A
/// moved-from grid can only be destroyed or assigned to.
template <int D>
class GAUSSMAP_API MomentGrid {
 public:
  struct alignas(32) Cell {  // two cache lines, never three
    CellKey<D> key;
    CellMoments<D> moments;
  };
  static_assert(sizeof(Cell) <= 96, "a finest cell must fit into one and a half cache lines");

  /// Cells of side `resolution` [m]. Throws std::invalid_argument unless it is positive and finite.
  explicit MomentGrid(double resolution);

  double resolution() const { return resolution_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// In order of first touch.
  const Cell& operator[](std::size_t index) const { return chunks_[index / kChunk][index % kChunk]; }
  /// The sums of a cell, nothing if it has no point.
  const CellMoments<D>* find(const CellKey<D>& key) const;
  /// Points counted so far.
  std::int64_t pointCount() const { return point_count_; }

  /// Counts the finite points of a block [m, map frame] and returns how many they were.
  /// Throws std::out_of_range, naming the point, if one is too far for 32-bit cells, and std::length_error if a cell
  /// would hold more points than CellMoments can; the block is then not counted.
  std::size_t add(const PointBlock<D>& block);

  /// Counts `count` points, `point(i)` giving anything indexable by axis ([0], [1], ...). Returns how many were finite.
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
  std::size_t addPoints(const std::vector<Vector<D>>& points) {
    return addPoints(points.size(), [&](std::size_t i) -> const Vector<D>& { return points[i]; });
  }

  /// Adds moments to one cell.
  void add(const CellKey<D>& key, const CellMoments<D>& moments);

  /// Adds all cells of another grid of the same resolution, on `threads` threads (0 = all): exact, so any order of
  /// merging gives the same sums. Throws std::invalid_argument if the resolutions differ.
  void merge(const MomentGrid& other, int threads = 0);

  /// Bytes held: of chunks, what cells have taken so far.
  std::size_t memoryBytes() const;

 private:
  struct Slot {
    std::uint32_t hash;   // of the key: most slots are told apart without a look at their cell
    std::uint32_t index;  // kEmpty or the cell's
  };
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  static constexpr std::size_t kChunk = 65536;  // whole huge pages; what is not touched takes no memory
  static constexpr std::uint32_t kEmpty = 0xFFFFFFFFu;

  Cell& cell(std::uint32_t index) { return chunks_[index / kChunk][index % kChunk]; }
  /// The first cell with that hash, most likely the one looked for; kEmpty if there is none.
  std::uint32_t candidate(std::uint32_t hash) const;
  static void prefetch(const Cell& cell);
  std::uint32_t indexOf(const CellKey<D>& key, std::uint32_t hash) const;  // kEmpty if it is not there
  Cell& findOrInsert(const CellKey<D>& key, std::uint32_t hash);
  /// Room for so many cells in chunks and slots.
  void reserve(std::size_t cells);
  /// Makes a cell that is behind the last one the last one.
  void enter(std::uint32_t hash);
  void widen(std::size_t slot_count);

  double resolution_;
  std::size_t size_ = 0;
  std::int64_t point_count_ = 0;
  std::size_t slot_count_ = 0;  // a power of two
  std::vector<std::unique_ptr<Cell[], Free>> chunks_;
  std::unique_ptr<Slot[], Free> slots_;
};

/// Counts points [map frame] on `threads` threads (0 = all), which never show in the sums: they are exact. Non-finite
/// points are left out. Throws std::invalid_argument unless the resolution [m] is positive and finite,
/// std::out_of_range, naming the point, if one is too far for 32-bit cells.
GAUSSMAP_API MomentGrid<3> countPoints(double resolution, const PointsView& points, int threads = 0);

}  // namespace gaussmap
