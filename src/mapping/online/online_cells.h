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

/// A Gaussian of the map while it is built on line.
template <int D>
struct OnlineCluster {
  Gaussian<D> gaussian;  // mean about the centre of its cell
  double area = 1.0;     // finest cells that it represents
  float log_odds = 0.0f;
  std::uint32_t parent = 0;  // its cluster, among those of the parent cell
  Evidence evidence;
};

/// The clusters of a cell. Most cells hold one, which needs no memory of its own.
template <int D>
using OnlineClusters = boost::container::small_vector<OnlineCluster<D>, 1>;

/// A cell of any scale. The finest hold one cluster.
template <int D>
struct OnlineCell {
  CellKey<D> key;
  std::uint32_t parent = 0;             // cell of the coarser scale
  std::uint32_t place = 0;              // among the children of the parent
  std::vector<std::uint32_t> children;  // cells of the finer scale
  OnlineClusters<D> clusters;
  bool alive = false;
  bool stale = false;  // coarse: a child has changed since the clusters were summed
  double need = 0.0;   // coarse: what one more cluster would gain, as of the last refinement that touched it
  double spare = 0.0;  // coarse: what its last cluster gained
};

/// The cells of all scales while the map changes. An index stays the cell's until it is erased; then it is given to
/// the next new cell, so that memory does not grow with time.
template <int D>
class OnlineCells {
 public:
  static constexpr std::uint32_t kNone = KeyIndex::kNone;

  explicit OnlineCells(const Grid<D>& grid) : grid_(grid), scales_(static_cast<std::size_t>(grid.scales())) {}

  const Grid<D>& grid() const { return grid_; }
  int scales() const { return grid_.scales(); }
  /// Slots of a scale, dead ones too.
  std::size_t slots(int scale) const { return level(scale).cells.size(); }
  /// Cells of a scale.
  std::size_t size(int scale) const { return level(scale).index.size(); }
  std::size_t clusterCount(int scale) const { return level(scale).clusters; }
  OnlineCell<D>& cell(std::uint32_t i, int scale) { return level(scale).cells[i]; }
  const OnlineCell<D>& cell(std::uint32_t i, int scale) const { return level(scale).cells[i]; }
  /// Sums of a finest cell.
  CellMoments<D>& moments(std::uint32_t i) { return moments_[i]; }
  const CellMoments<D>& moments(std::uint32_t i) const { return moments_[i]; }

  /// kNone if there is no such cell.
  std::uint32_t find(const CellKey<D>& key, int scale) const;
  /// The finest cell of a key, created with its ancestors if it does not exist; a new one has no cluster yet.
  std::uint32_t findOrInsert(const CellKey<D>& key);
  /// Erases a finest cell, and the coarse clusters and cells that represented nothing else. Calls
  /// `gone(cell, cluster, scale)` before each cluster is erased.
  template <typename Gone>
  void erase(std::uint32_t finest, const Gone& gone);
  /// Replaces the clusters of a coarse cell.
  void setClusters(std::uint32_t i, int scale, OnlineClusters<D> clusters);
  /// Gives a new finest cell its cluster.
  void addCluster(std::uint32_t i, int scale, const OnlineCluster<D>& cluster);

  /// The clusters of the finer cells under a coarse cell, in the order of `children`, means about the coarse centre.
  std::vector<Gaussian<D>> dataUnder(std::uint32_t i, int scale) const;
  template <typename Body>
  void forClustersUnder(std::uint32_t i, int scale, const Body& body) {
    for (const std::uint32_t child : cell(i, scale).children)
      for (OnlineCluster<D>& cluster : cell(child, scale - 1).clusters) body(cluster);
  }
  /// Recomputes stale coarse clusters of the cell from the finer ones linked to them, [9], [10].
  void refresh(std::uint32_t i, int scale);
  /// Marks a coarse cell and its ancestors as stale: a cell under it has changed. All ancestors of a stale cell are
  /// stale.
  void markStale(std::uint32_t i, int scale);

  std::size_t memoryBytes() const;

 private:
  struct Level {
    std::deque<OnlineCell<D>> cells;  // grows without moving what is there
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
      // A cluster that no finer one is linked to represents nothing any more.
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
      i = dead.parent;               // a coarser cluster may have represented the one that is gone
      continue;
    }
    if (scale > 0)
      for (std::size_t c = 0; c < dead.clusters.size(); ++c) gone(i, c, scale);
    const std::uint32_t parent = dead.parent;
    eraseCell(i, scale);
    i = parent;
  }
}

/// The finest cells in the form that object_rules.h takes.
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
