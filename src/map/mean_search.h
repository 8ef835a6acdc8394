// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "gaussmap/map/gaussian_map.h"
#include "map/map_means.h"

namespace gaussmap::detail {

/// Searches the means of a map from the coarsest scale down. It needs no other data than the map: in key order, each
/// range of cells is a binary tree, because the keys of its first and its last cell bound it.
template <int D>
class MeanSearch {
 public:
  /// `scale`: the scale whose means are searched, or kLeaves. The point must be in the grid's range.
  static constexpr int kLeaves = -1;
  MeanSearch(const GaussianMap<D>& map, const Vector<D>& point, int scale) : map_(map), point_(point), scale_(scale) {
    for (int s = 0; s < map.scales(); ++s) {
      Level& level = levels_[static_cast<std::size_t>(s)];
      level.keys = map.scale(s).keys.data();
      level.square_side = map.grid().side(s) * map.grid().side(s);
      level.below = (point / map.grid().side(s)).array() + kSlack;
      level.above = (point / map.grid().side(s)).array() - (1.0 + kSlack);
    }
  }

  /// Adds the means within `found.limit()` [m] to `found` (see nearest_list.h), near ones first. The limit can shrink
  /// meanwhile. The index of a result is packed by packId().
  template <typename Found>
  void run(Found& found) const {
    const int coarsest = map_.scales() - 1;
    if (map_.cellCount(coarsest) > 0) visit(coarsest, 0, map_.cellCount(coarsest), found);
  }

  static std::uint64_t packId(int scale, std::size_t index) { return std::uint64_t(scale) << 32 | index; }
  static int scaleOf(std::uint64_t id) { return static_cast<int>(id >> 32); }
  static std::size_t indexOf(std::uint64_t id) { return id & 0xFFFFFFFFu; }

 private:
  static constexpr std::size_t kFew = 8;         // cells that are compared one by one
  static constexpr double kSlack = 2e-3;         // [cells]; a mean can lie 1e-3 outside its cell
  static constexpr std::size_t kMaxScales = 31;  // see Grid

  struct Near {
    double square;
    std::size_t cell;
  };

  struct Level {
    const CellKey<D>* keys;
    double square_side;      // [m^2]
    Vector<D> below, above;  // the point [cells]: a cell k is apart by k - below or above - k
  };

  /// Returns the square of the distance of the point from an interval of cells on one axis [cells^2].
  static double squaredGap(const Level& level, std::size_t axis, std::int32_t first, std::int32_t last) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double gap = std::max(0.0, std::max(double(first) - level.below(i), level.above(i) - double(last)));
    return gap * gap;
  }

  /// Returns the square of the distance of the point from a cell [m^2].
  static double squaredGap(const Level& level, const CellKey<D>& key) {
    double square = 0.0;
    for (std::size_t axis = 0; axis < D; ++axis) square += squaredGap(level, axis, key[axis], key[axis]);
    return square * level.square_side;
  }

  /// Returns a lower bound of the same for all cells of a range that have one parent.
  static double squaredGap(const Level& level, std::size_t first, std::size_t last) {
    const CellKey<D>&a = level.keys[first], &b = level.keys[last - 1];
    double square = 0.0;
    for (std::size_t axis = 0; axis < D; ++axis) {
      square += squaredGap(level, axis, a[axis], b[axis]);
      if (a[axis] != b[axis]) break;  // the next axes are not sorted
    }
    return square * level.square_side;
  }

  template <typename Found>
  static bool isNear(double square, const Found& found) {
    return square <= found.limit() * found.limit();
  }

  /// Visits the cells of a range that have one parent, or all coarsest cells.
  template <typename Found>
  void visit(int scale, std::size_t first, std::size_t last, Found& found) const {
    const Level& level = levels_[static_cast<std::size_t>(scale)];
    if (last - first > kFew) {
      const std::size_t middle = first + (last - first) / 2;
      const double left = squaredGap(level, first, middle), right = squaredGap(level, middle, last);
      const bool right_first = right < left;
      if (right_first && isNear(right, found)) visit(scale, middle, last, found);
      if (isNear(left, found)) visit(scale, first, middle, found);
      if (!right_first && isNear(right, found)) visit(scale, middle, last, found);
      return;
    }
    Near near[kFew];
    std::size_t count = 0;
    for (std::size_t cell = first; cell < last; ++cell) {
      const double square = squaredGap(level, level.keys[cell]);
      if (!isNear(square, found)) continue;
      std::size_t place = count++;
      for (; place > 0 && square < near[place - 1].square; --place) near[place] = near[place - 1];
      near[place] = {square, cell};
    }
    for (std::size_t i = 0; i < count && isNear(near[i].square, found); ++i) enter(scale, near[i].cell, found);
  }

  template <typename Found>
  void enter(int scale, std::size_t cell, Found& found) const {
    if (scale == scale_ || (scale_ == kLeaves && map_.isLeaf(cell, scale))) return look(scale, cell, found);
    const IndexRange children = map_.childCells(cell, scale);
    if (!children.empty()) visit(scale - 1, children.first, children.last, found);
  }

  template <typename Found>
  void look(int scale, std::size_t cell, Found& found) const {
    const Vector<D> local = point_ - map_.grid().centre(map_.scale(scale).keys[cell], scale);
    const IndexRange range = map_.gaussiansOf(cell, scale);
    for (std::size_t i = range.first; i < range.last; ++i)
      found.add((localMean<D>(map_, i, scale) - local).norm(), packId(scale, i));
  }

  const GaussianMap<D>& map_;
  const Vector<D>& point_;
  int scale_;
  std::array<Level, kMaxScales> levels_;
};

}  // namespace gaussmap::detail
