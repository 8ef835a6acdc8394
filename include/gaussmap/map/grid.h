// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gaussmap/core/cell_moments.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Integer coordinates of a cell at its scale. Cell k covers [k, k + 1) * side along each axis.
/// All grids have their origin at 0, so maps of equal resolution and ratio share their cells.
template <int D>
using CellKey = std::array<std::int32_t, D>;

/// Returns a key as text for messages, for example "(1, -2, 0)".
template <int D>
GAUSSMAP_API std::string toString(const CellKey<D>& key);

/// Options of the cells of a map. Two maps with equal options share their cells at every scale.
struct MapOptions {
  double resolution = 0.1;  ///< a_0, side of the cells of the finest scale (scale 0) [m], > 0
  int ratio = 10;           ///< a cell of scale s + 1 is `ratio` times as wide, >= 2 (2 = a classical octree)
  int scales = 3;           ///< number of scales, >= 1
  double noise = 0.0;       ///< standard deviation added to every covariance [m]; 0: resolution / 20

  /// Returns true if all options are equal.
  friend bool operator==(const MapOptions& a, const MapOptions& b) {
    return a.resolution == b.resolution && a.ratio == b.ratio && a.scales == b.scales && a.noise == b.noise;
  }
};

/// An axis-aligned box [m, map frame].
template <int D>
struct Box {
  Vector<D> low;   ///< smallest coordinates
  Vector<D> high;  ///< largest coordinates
};

/// Returns true if low <= point < high along every axis.
template <int D>
GAUSSMAP_API bool isInBox(const Box<D>& box, const Vector<D>& point);

/// Computes sides, keys, centres and parents of cells. Scale s has cells of side resolution * ratio^s.
template <int D>
class GAUSSMAP_API Grid {
 public:
  /// Makes the grid of a map. Throws std::invalid_argument if an option is not usable; the message names the option.
  explicit Grid(const MapOptions& options = {});

  /// Returns the options, with the automatic noise filled in.
  const MapOptions& options() const { return options_; }
  /// Returns the number of scales.
  int scales() const { return options_.scales; }
  /// Returns the side of the cells of a scale [m].
  double side(int scale) const { return sides_[static_cast<std::size_t>(scale)]; }
  /// Returns the number of finest cells along the side of a cell of this scale: ratio^scale.
  std::int64_t cellsAlongSide(int scale) const { return spans_[static_cast<std::size_t>(scale)]; }

  /// Returns the cell that holds a point [m, map frame].
  ///
  /// The point is first rounded to the lattice of side_0 / 65536, as in CellMoments. A lookup therefore finds the cell
  /// in which the point was counted. Throws std::out_of_range if the point is not finite or an index of its finest cell
  /// does not fit 32 bits; the message gives the point.
  CellKey<D> keyOf(const Vector<D>& point, int scale = 0) const;

  /// Returns the cell of the coarser scale `to` that contains cell `key` of scale `from`. The division rounds down,
  /// also for negative coordinates.
  CellKey<D> ancestor(const CellKey<D>& key, int from, int to) const;

  /// Returns true if cell `parent` of the next coarser scale contains cell `key`. The test uses no division, because it
  /// runs for every cell of a map.
  bool isParent(const CellKey<D>& parent, const CellKey<D>& key) const {
    bool is_parent = true;
    for (std::size_t axis = 0; axis < D; ++axis)
      is_parent &= static_cast<std::uint64_t>(key[axis] - std::int64_t{parent[axis]} * options_.ratio) <
                   static_cast<std::uint64_t>(options_.ratio);
    return is_parent;
  }

  /// Returns the centre of a cell [m, map frame].
  Vector<D> centre(const CellKey<D>& key, int scale) const;
  /// Returns the box of a cell [m, map frame].
  Box<D> boxOf(const CellKey<D>& key, int scale) const;

  /// Returns the centre of a cell minus the centre of its parent [m]. The result is exact, also far from the origin.
  Vector<D> centreInParent(const CellKey<D>& key, int scale) const;
  /// Returns the same for a known parent, without computing its key.
  Vector<D> centreInParent(const CellKey<D>& key, const CellKey<D>& parent, int scale) const;

 private:
  MapOptions options_;
  std::vector<double> sides_;
  std::vector<std::int64_t> spans_;
};

}  // namespace gaussmap
