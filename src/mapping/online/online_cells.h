// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "core/key_index.h"
#include "gaussmap/core/cell_moments.h"
#include "gaussmap/map/grid.h"
#include "gaussmap/sensor/visibility.h"

namespace gaussmap::detail {

/// A Gaussian of a map that is built online.
template <int D>
struct OnlineCluster {
  Gaussian<D> gaussian;  // mean about the centre of its cell
  double area = 1.0;     // number of finest cells that it represents
  float log_odds = 0.0f;
  std::uint32_t parent = 0;  // index of its parent among the clusters of the parent cell
  Evidence evidence;
};

/// The clusters of a cell. Most cells hold one cluster, which is stored without a separate allocation.
template <int D>
using OnlineClusters = boost::container::small_vector<OnlineCluster<D>, 1>;

/// A cell of any scale. A finest cell holds one cluster.
template <int D>
struct OnlineCell {
  CellKey<D> key;
  std::uint32_t parent = 0;             // parent cell, at the next coarser scale
  std::uint32_t place = 0;              // position among the children of the parent
  std::vector<std::uint32_t> children;  // child cells, at the next finer scale
  OnlineClusters<D> clusters;
  bool alive = false;
  bool stale = false;  // coarse cells: a child has changed since the clusters were computed
  double need = 0.0;   // coarse cells: gain of one more cluster, as of the last refinement that touched the cell
  double spare = 0.0;  // coarse cells: gain of the last cluster, which is lost if it is taken away
};

/// The cells of all scales of a map that changes. A cell keeps its index until it is erased. A later new cell then gets
/// this index again, so the memory does not grow with time.
template <int D>
class OnlineCells {
 public:
  static constexpr std::uint32_t kNone = KeyIndex::kNone;

  explicit OnlineCells(const Grid<D>& grid) : grid_(grid), scales_(static_cast<std::size_t>(grid.scales())) {}

  const Grid<D>& grid() const { return grid_; }
  int scales() const { return grid_.scales(); }
  /// Number of slots of a scale, including those of erased cells.
  std::size_t slots(int scale) const { return level(scale).cells.size(); }
  /// Number of cells of a scale.
  std::size_t size(int scale) const { return level(scale).index.size(); }
  std::size_t clusterCount(int scale) const { return level(scale).clusters; }
  OnlineCell<D>& cell(std::uint32_t i, int scale) { return level(scale).cells[i]; }
  const OnlineCell<D>& cell(std::uint32_t i, int scale) const { return level(scale).cells[i]; }
  /// Moments of a finest cell.
  CellMoments<D>& moments(std::uint32_t i) { return moments_[i]; }
  const CellMoments<D>& moments(std::uint32_t i) const { return moments_[i]; }

  /// Returns the index of a cell, or kNone if there is no such cell.
  std::uint32_t find(const CellKey<D>& key, int scale) const;
  /// Returns the finest cell with a key. If it does not exist, creates it, and its missing ancestors, without clusters.
  std::uint32_t findOrInsert(const CellKey<D>& key);
  /// Erases a finest cell, and then the coarse clusters and cells that have no children left. Calls
  /// gone(cell, cluster, scale) before each cluster is erased.
  template <typename Gone>
  void erase(std::uint32_t finest, const Gone& gone);
  /// Replaces the clusters of a coarse cell.
  void setClusters(std::uint32_t i, int scale, OnlineClusters<D> clusters);
  /// Gives a new finest cell its cluster.
  void addCluster(std::uint32_t i, int scale, const OnlineCluster<D>& cluster);

  /// Returns the clusters of the child cells of a coarse cell, in the order of `children`. Their means are about the
  /// centre of the coarse cell [m].
  std::vector<Gaussian<D>> dataUnder(std::uint32_t i, int scale) const;
  /// Calls body(cluster) for the clusters of dataUnder(), in the same order.
  template <typename Body>
  void forClustersUnder(std::uint32_t i, int scale, const Body& body) {
    for (const std::uint32_t child : cell(i, scale).children)
      for (OnlineCluster<D>& cluster : cell(child, scale - 1).clusters) body(cluster);
  }
  /// Recomputes the clusters of a stale coarse cell from their children, Yguel 2009 eqs. (9), (10). Stale cells under
  /// it are recomputed first.
  void refresh(std::uint32_t i, int scale);
  /// Marks a coarse cell and all its ancestors as stale, because a cell under it has changed. So all ancestors of a
  /// stale cell are always stale.
  void markStale(std::uint32_t i, int scale);

  std::size_t memoryBytes() const;

 private:
  struct Level {
    std::deque<OnlineCell<D>> cells;  // a deque, because it grows without moving the cells
    std::vector<std::uint32_t> free;
    KeyIndex index;
    std::size_t clusters = 0;
  };
  Level& level(int scale) { return scales_[static_cast<std::size_t>(scale)]; }
  const Level& level(int scale) const { return scales_[static_cast<std::size_t>(scale)]; }
  std::uint32_t insert(const CellKey<D>& key, int scale);
  void eraseCell(std::uint32_t i, int scale);

  Grid<D> grid_;
  std::vector<Level> scales_;
  std::deque<CellMoments<D>> moments_;
};

template <int D>
template <typename Gone>
void OnlineCells<D>::erase(std::uint32_t finest, const Gone& gone) {
  std::uint32_t i = finest;
  for (int scale = 0; scale < scales(); ++scale) {
    OnlineCell<D>& dead = cell(i, scale);
    if (scale == 0) gone(i, std::size_t{0}, 0);
    if (scale > 0 && !dead.children.empty()) {
      // A cluster without children represents nothing, so it is erased.
      std::vector<std::uint32_t> members(dead.clusters.size(), 0);
      forClustersUnder(i, scale, [&](OnlineCluster<D>& finer) { ++members[finer.parent]; });
      OnlineClusters<D> left;
      std::vector<std::uint32_t> place(dead.clusters.size(), 0);
      for (std::size_t c = 0; c < dead.clusters.size(); ++c) {
        place[c] = static_cast<std::uint32_t>(left.size());
        if (members[c] > 0)
          left.push_back(dead.clusters[c]);
        else
          gone(i, c, scale);
      }
      if (left.size() == dead.clusters.size()) return;
      forClustersUnder(i, scale, [&](OnlineCluster<D>& finer) { finer.parent = place[finer.parent]; });
      setClusters(i, scale, std::move(left));
      dead.need = dead.spare = 0.0;  // unknown until the next refinement that touches the cell
      i = dead.parent;               // the parents of the erased clusters may have no children left
      continue;
    }
    if (scale > 0)
      for (std::size_t c = 0; c < dead.clusters.size(); ++c) gone(i, c, scale);
    const std::uint32_t parent = dead.parent;
    eraseCell(i, scale);
    i = parent;
  }
}

/// Gives the functions of object_rules.h access to the finest cells.
template <int D>
struct FinestOnlineCells {
  using Index = std::uint32_t;
  static constexpr int kDimensions = D;

  const OnlineCells<D>& cells;

  std::size_t slots() const { return cells.slots(0); }
  double side() const { return cells.grid().side(0); }
  const CellKey<D>& key(Index i) const { return cells.cell(i, 0).key; }
  std::optional<Index> find(const CellKey<D>& key) const {
    const Index found = cells.find(key, 0);
    return found == OnlineCells<D>::kNone ? std::nullopt : std::optional(found);
  }
  const Evidence& evidence(Index i) const { return cells.cell(i, 0).clusters[0].evidence; }
  const Vector<D>& mean(Index i) const { return cells.cell(i, 0).clusters[0].gaussian.mean; }
};

}  // namespace gaussmap::detail
