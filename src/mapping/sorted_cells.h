// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/huge_pages.h"
#include "gaussmap/core/cell_moments.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/map/grid.h"

namespace gaussmap::detail {

/// The finite points of a cloud, sorted into nested cells. The cells of level 0 have a given side. From one level to
/// the next, the side doubles. The cells of a level are those of a Grid whose resolution is the side of the level.
class SortedPoints {
 public:
  static constexpr int kMaxBits = 20;

  /// `side`: side of the cells of level 0 [m]. If it is 0, the longest side of the bounding box has almost 2^(bits - 1)
  /// cells, but a cell is not smaller than the resolution of the float coordinates. `bits` is used only for this.
  /// Throws std::out_of_range if the codes need more than kMaxBits bits per axis, or if the points are too far from the
  /// origin for cells of this side.
  SortedPoints(const PointsView& points, double side, int bits);

  /// Returns the number of finite points.
  std::size_t size() const { return indices_.size(); }
  /// Returns the bits of a code per axis.
  int bits() const { return bits_; }
  /// Returns the longest side of the bounding box [m].
  double extent() const { return extent_; }
  /// Returns the number of occupied cells of a level.
  std::size_t cellCount(int level) const { return counts_[static_cast<std::size_t>(level)]; }
  /// Returns the side of the cells of a level [m].
  double side(int level) const { return side_ * static_cast<double>(std::int64_t{1} << level); }
  /// Returns the index of the i-th point in the cloud. The points are sorted by code. Equal codes are in the order of
  /// the cloud.
  std::uint32_t index(std::size_t i) const { return indices_[i]; }
  /// Returns the Morton code of the level-0 cell of the i-th point.
  std::uint64_t code(std::size_t i) const { return codes_[i]; }
  /// Returns the key of the cell of a level that has this code. The code is already shifted to the level.
  CellKey<3> keyOf(std::uint64_t code, int level) const;

 private:
  void sortPacked(std::vector<std::uint64_t, PagesAllocator<std::uint64_t>>& items, int index_bits);
  void countCells();

  double side_ = 1.0, extent_ = 0.0;
  int bits_ = 1;
  std::array<std::int64_t, 3> base_{};  // cell of level 0 with code 0: a multiple of 2^(bits - 1)
  std::vector<std::uint64_t, PagesAllocator<std::uint64_t>> codes_;
  std::vector<std::uint32_t, PagesAllocator<std::uint32_t>> indices_;
  std::array<std::size_t, kMaxBits + 1> counts_{};
};

/// The cells of one level, in the order of their codes, with exact moments.
struct SortedCells {
  double side = 1.0;                 // [m]
  std::vector<CellKey<3>> keys;      // of the grid with this resolution
  std::vector<std::uint64_t> codes;  // shifted to the level
  std::vector<CellMoments<3>> moments;
  std::vector<std::uint32_t> first_point;  // n + 1 positions in SortedPoints
};

/// Returns the cells of a level. Points are rounded to the lattice of CellMoments, but never into another cell.
SortedCells cellsOf(const SortedPoints& sorted, const PointsView& points, int level);

}  // namespace gaussmap::detail
