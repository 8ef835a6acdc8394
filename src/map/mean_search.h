// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "gaussmap/map/gaussian_map.h"
#include "map/map_means.h"

namespace gaussmap::detail {

/// Searches the means of a map, from the coarsest scale to the finer ones. It needs no data except the map. The cells
/// with one parent are sorted by key, and halving such a range again and again gives a binary tree. The keys of the
/// first and the last cell of a part bound all its cells.
template <int D>
class MeanSearch {
 public:
  static constexpr int kLeaves = -1;
  /// `scale`: the scale whose means are searched, or kLeaves. The point must be in the grid's range. The map and the
  /// point must live as long as this object.
  MeanSearch(const GaussianMap<D>& map, const Vector<D>& point, int scale) : map_(map), point_(point), scale_(scale) {
    for (int s = 0; s < map.scales(); ++s) {
      Level& level = levels_[static_cast<std::size_t>(s)];
      level.keys = map.scale(s).keys.data();
      level.per_side = 1.0 / map.grid().side(s);
      level.square_side = map.grid().side(s) * map.grid().side(s);
      level.below = (point / map.grid().side(s)).array() + kSlack;
      level.above = (point / map.grid().side(s)).array() - (1.0 + kSlack);
    }
  }

  /// Adds the means within `found.limit()` [m] to `found` (see nearest_list.h), visiting near cells first. The limit
  /// can shrink during the search. The index of a result is that of packId().
  template <typename Found>
  void searchNearFirst(Found& found) const {
    search<false>(map_.scales() - 1, 0, map_.cellCount(map_.scales() - 1), found);
  }
  /// Adds the same means, but visits the cells in key order. This is faster if the limit is a few cells, or if it
  /// cannot shrink.
  template <typename Found>
  void searchBox(Found& found) const {
    search<true>(map_.scales() - 1, 0, map_.cellCount(map_.scales() - 1), found);
  }

  /// Packs the scale and the index of a Gaussian into one number. Its order is by scale, then by index.
  static std::uint64_t packId(int scale, std::size_t index) {
    return static_cast<std::uint64_t>(scale) * kIndices + index;
  }
  static int scaleOf(std::uint64_t id) { return static_cast<int>(id / kIndices); }
  static std::size_t indexOf(std::uint64_t id) { return id % kIndices; }

 private:
  static constexpr std::uint64_t kIndices = 1ull << 32;  // a Gaussian's index has 32 bits
  static constexpr std::size_t kFew = 8;                 // cells that are compared one by one
  static constexpr double kSlack = 2e-3;                 // [cells]; a mean can lie 1e-3 outside its cell
  static constexpr std::size_t kMaxScales = 31;          // see Grid

  struct Near {
    double square;
    std::size_t cell;
  };

  struct Level {
    const CellKey<D>* keys;
    double square_side;      // [m^2]
    double per_side;         // [1/m]
    Vector<D> below, above;  // the point [cells]: the gap to cell k is max(0, k - below, above - k) per axis
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

  /// Returns a lower bound of the squared distances [m^2] of the point from all cells of a range with one parent.
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

  /// Searches a range of cells that have one parent, or all coarsest cells.
  template <bool kBox, typename Found>
  void search(int scale, std::size_t first, std::size_t last, Found& found) const {
    if (first == last) return;
    if constexpr (kBox)
      visitBox(scale, first, last, found);
    else
      visit(scale, first, last, found);
  }

  /// Visits the cells of a range, the nearest half first.
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
    for (std::size_t i = 0; i < count && isNear(near[i].square, found); ++i) enter<false>(scale, near[i].cell, found);
  }

  /// Visits the cells of a range that are in a box around the point, in key order.
  template <typename Found>
  void visitBox(int scale, std::size_t first, std::size_t last, Found& found) const {
    const Level& level = levels_[static_cast<std::size_t>(scale)];
    const double radius = found.limit() * level.per_side;
    CellKey<D> low, high;
    for (std::size_t axis = 0; axis < D; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      low[axis] = asIndex(std::ceil(level.above(i) - radius));
      high[axis] = asIndex(std::floor(level.below(i) + radius));
    }
    std::size_t outside = 0;  // cells in a row
    for (std::size_t cell = first; cell < last;) {
      const CellKey<D>& key = level.keys[cell];
      bool is_inside = true;
      for (std::size_t axis = 0; axis < D; ++axis) {
        is_inside &= low[axis] <= key[axis];
        is_inside &= key[axis] <= high[axis];
      }
      if (is_inside) {
        outside = 0;
        if (isNear(squaredGap(level, key), found)) enter<true>(scale, cell, found);
      }
      ++cell;
      if (is_inside || ++outside < kFew) continue;
      if (const auto next = nextInBox(key, low, high))
        cell = jump(level.keys, cell, last, *next);
      else
        return;
      outside = 0;
    }
  }

  /// Returns a key above `key` such that no key between the two is in the box. `key` must be outside the box. Returns
  /// std::nullopt if the box has no key above `key`.
  static std::optional<CellKey<D>> nextInBox(const CellKey<D>& key, const CellKey<D>& low, const CellKey<D>& high) {
    CellKey<D> next = key;
    std::size_t axis = 0;
    while (low[axis] <= key[axis] && key[axis] <= high[axis]) ++axis;
    if (key[axis] > high[axis]) {
      while (axis > 0 && key[axis - 1] == high[axis - 1]) --axis;
      if (axis == 0) return std::nullopt;
      ++next[axis - 1];
    }
    for (; axis < D; ++axis) next[axis] = low[axis];
    return next;
  }

  /// Converts a whole number to the index of a cell, clamped to the range of the indices.
  static std::int32_t asIndex(double number) {
    constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
    return number <= kLeast ? kLeast : number >= kMost ? kMost : static_cast<std::int32_t>(number);
  }

  /// Returns the first of the cells `first`, `first` + 1, ... whose key is not below `key`, or `last`.
  static std::size_t jump(const CellKey<D>* keys, std::size_t first, std::size_t last, const CellKey<D>& key) {
    std::size_t step = 1, end = first;
    while (end < last && keys[end] < key) {
      first = end + 1;
      end += step;
      step *= 2;
    }
    return std::size_t(std::lower_bound(keys + first, keys + std::min(end, last), key) - keys);
  }

  template <bool kBox, typename Found>
  void enter(int scale, std::size_t cell, Found& found) const {
    if (scale == scale_ || (scale_ == kLeaves && map_.isLeaf(cell, scale))) return look(scale, cell, found);
    const IndexRange children = map_.childCells(cell, scale);
    search<kBox>(scale - 1, children.first, children.last, found);
  }

  template <typename Found>
  void look(int scale, std::size_t cell, Found& found) const {
    const Vector<D> local = point_ - map_.grid().centre(map_.scale(scale).keys[cell], scale);
    const IndexRange range = map_.gaussiansOf(cell, scale);
    for (std::size_t i = range.first; i < range.last; ++i) {
      const double square = (localMean<D>(map_, i, scale) - local).squaredNorm();
      constexpr double kRounding = 1e-12;  // the limit is a distance, not its square
      if (square * (1.0 - kRounding) <= found.limit() * found.limit()) found.add(std::sqrt(square), packId(scale, i));
    }
  }

  const GaussianMap<D>& map_;
  const Vector<D>& point_;
  int scale_;
  std::array<Level, kMaxScales> levels_;
};

}  // namespace gaussmap::detail
