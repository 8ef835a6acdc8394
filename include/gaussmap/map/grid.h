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

/// Integer coordinates of a cell at its scale; cell k covers [k, k + 1) * side on each axis.
/// There is no origin to agree on: maps of one resolution always share their cells.
template <int D>
using CellKey = std::array<std::int32_t, D>;

/// "(1, -2, 0)", for messages.
template <int D>
GAUSSMAP_API std::string toString(const CellKey<D>& key);

/// What a map is made of; two maps with equal options share their cells at every scale.
struct MapOptions {
  double resolution = 0.1;  ///< a_0, side of the cells of the finest scale (scale 0) [m], > 0
  int ratio = 10;           ///< a cell of scale s + 1 is `ratio` times as wide, >= 2 (2 = a classical octree)
  int scales = 3;           ///< how many scales, >= 1
  double noise = 0.0;       ///< standard deviation added to every covariance [m]; 0: resolution / 20

  friend bool operator==(const MapOptions& a, const MapOptions& b) {
    return a.resolution == b.resolution && a.ratio == b.ratio && a.scales == b.scales && a.noise == b.noise;
  }
};

/// An axis-aligned box [m, map frame].
template <int D>
struct Box {
  Vector<D> low;
  Vector<D> high;
};

/// low <= point < high along every axis.
template <int D>
GAUSSMAP_API bool isInBox(const Box<D>& box, const Vector<D>& point);

/// Where cells are: sides, keys, centres, parents. Scale s has cells of side resolution * ratio^s.
template <int D>
class GAUSSMAP_API Grid {
 public:
  /// Throws std::invalid_argument, naming the option, if the options describe no usable grid.
  explicit Grid(const MapOptions& options = {});

  /// The options, with the automatic noise filled in.
  const MapOptions& options() const { return options_; }
  int scales() const { return options_.scales; }
  /// Side of the cells of a scale [m].
  double side(int scale) const { return sides_[static_cast<std::size_t>(scale)]; }
  /// How many finest cells fit along a side of a cell of this scale: ratio^scale.
  std::int64_t cellsAlongSide(int scale) const { return spans_[static_cast<std::size_t>(scale)]; }

  /// The cell that holds a point [m, map frame]. The point is first snapped to the lattice of
  /// side_0 / 65536, as in CellMoments, so that a lookup finds the cell its point was counted in.
  /// Throws std::out_of_range, naming the point, if it is not finite or the index does not fit 32 bits.
  CellKey<D> keyOf(const Vector<D>& point, int scale = 0) const;

  /// The cell of the coarser scale `to` that holds a cell of scale `from`; floor, also for negative coordinates.
  CellKey<D> ancestor(const CellKey<D>& key, int from, int to) const;

  /// Is a cell the parent, at the next coarser scale, of another? No division: what is asked of every cell of a map.
  bool isParent(const CellKey<D>& parent, const CellKey<D>& key) const {
    bool is_parent = true;
    for (std::size_t axis = 0; axis < D; ++axis)
      is_parent &= static_cast<std::uint64_t>(key[axis] - std::int64_t{parent[axis]} * options_.ratio) <
                   static_cast<std::uint64_t>(options_.ratio);
    return is_parent;
  }

  /// Centre of a cell [m, map frame].
  Vector<D> centre(const CellKey<D>& key, int scale) const;
  /// The box of a cell [m, map frame].
  Box<D> boxOf(const CellKey<D>& key, int scale) const;

  /// Centre of a cell minus the centre of its parent [m]: exact wherever the cell is.
  Vector<D> centreInParent(const CellKey<D>& key, int scale) const;
  /// The same where the parent is known.
  Vector<D> centreInParent(const CellKey<D>& key, const CellKey<D>& parent, int scale) const;

 private:
  MapOptions options_;
  std::vector<double> sides_;
  std::vector<std::int64_t> spans_;
};

}  // namespace gaussmap
