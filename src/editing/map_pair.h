// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"

namespace gaussmap::detail {

/// A cell of the merged map: its index in each of the two maps, std::nullopt if the map does not have it.
struct CellPair {
  std::optional<std::size_t> a, b;
};

/// A Gaussian of one of the two maps.
template <int D>
struct SourceGaussian {
  Gaussian<D> gaussian;  ///< mean about the centre of its cell [m]
  float log_odds;
  bool in_b;
  std::size_t index;  ///< in its map and scale
};

/// Two maps of one grid that are merged, and the cells of the merged map.
///
/// Cells are in key order, so the children of a cell are consecutive. If both maps have a coarse cell and it is a leaf
/// of one of them, it becomes a leaf of the merged map: what the finer cells of the other map hold is only a part of
/// what the merged cell represents.
template <int D>
class MapPair {
 public:
  /// Keeps references to the maps.
  MapPair(const GaussianMap<D>& a, const GaussianMap<D>& b);

  const GaussianMap<D>& a() const { return a_; }
  const GaussianMap<D>& b() const { return b_; }
  const Grid<D>& grid() const { return a_.grid(); }
  int scales() const { return a_.scales(); }
  const std::vector<CellPair>& cells(int s) const { return cells_[static_cast<std::size_t>(s)]; }
  /// Returns the first child of every cell of scale s >= 1, as an index of cells(s - 1).
  const std::vector<std::uint32_t>& firstChild(int s) const { return first_child_[static_cast<std::size_t>(s)]; }

  const CellKey<D>& keyOf(const CellPair& pair, int s) const {
    return pair.a ? a_.scale(s).keys[*pair.a] : b_.scale(s).keys[*pair.b];
  }
  /// Returns the larger one of the numbers of Gaussians that the two maps have in a cell of scale s.
  std::size_t countIn(const CellPair& pair, int s) const;
  /// Returns the Gaussians of both maps in a cell of scale s. They are sorted by their values, so their order does not
  /// depend on which map is first.
  std::vector<SourceGaussian<D>> sourcesIn(const CellPair& pair, int s) const;

  bool hasOccupancy() const { return a_.hasOccupancy() || b_.hasOccupancy(); }
  /// Returns the log-odds of a cell or cluster from its log-odds in each map: their sum, within the limits, if both
  /// maps have it and have occupancy. Otherwise the value of one map is used.
  float combined(std::optional<float> in_a, std::optional<float> in_b) const;
  /// Returns the log-odds of cluster `part` of these sources: combined() of the maximum of its members in each map.
  float combined(const std::vector<SourceGaussian<D>>& sources, const std::vector<int>& label, int part) const;

  /// Returns the finest scale of the merged map if both maps hold moments: their sums, and combined() log-odds. Throws
  /// std::invalid_argument if a cell would hold 2^33 points or more.
  MapScale<D> addMoments() const;

 private:
  const GaussianMap<D>&a_, &b_;
  std::vector<std::vector<CellPair>> cells_;             // per scale
  std::vector<std::vector<std::uint32_t>> first_child_;  // per scale; empty at scale 0
};

}  // namespace gaussmap::detail
