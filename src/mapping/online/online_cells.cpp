// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/online/online_cells.h"

#include <limits>
#include <stdexcept>
#include <utility>

namespace gaussmap::detail {

template <int D>
std::uint32_t OnlineCells<D>::find(const CellKey<D>& key, int scale) const {
  const Level& at = level(scale);
  return at.index.find(KeyIndex::hashOf(key), [&](std::uint32_t i) { return at.cells[i].key == key; });
}

template <int D>
std::uint32_t OnlineCells<D>::insert(const CellKey<D>& key, int scale) {
  Level& at = level(scale);
  std::uint32_t i = 0;
  if (!at.free.empty()) {
    i = at.free.back();
    at.free.pop_back();
  } else {
    if (at.cells.size() >= kNone) throw std::length_error("a scale holds at most 2^32 - 1 cells");
    i = static_cast<std::uint32_t>(at.cells.size());
    at.cells.emplace_back();
    if (scale == 0) moments_.emplace_back();
  }
  OnlineCell<D>& cell = at.cells[i];
  cell.key = key;
  cell.alive = true;
  at.index.insert(KeyIndex::hashOf(key), i);
  return i;
}

template <int D>
std::uint32_t OnlineCells<D>::findOrInsert(const CellKey<D>& key) {
  const std::uint32_t known = find(key, 0);
  if (known != kNone) return known;
  const std::uint32_t finest = insert(key, 0);
  std::uint32_t child = finest;
  for (int scale = 1; scale < scales(); ++scale) {
    const CellKey<D> above = grid_.ancestor(key, 0, scale);
    std::uint32_t parent = find(above, scale);
    const bool is_new = parent == kNone;
    if (is_new) parent = insert(above, scale);
    std::vector<std::uint32_t>& siblings = cell(parent, scale).children;
    cell(child, scale - 1).parent = parent;
    cell(child, scale - 1).place = static_cast<std::uint32_t>(siblings.size());
    siblings.push_back(child);
    if (!is_new) break;
    child = parent;
  }
  return finest;
}

template <int D>
void OnlineCells<D>::eraseCell(std::uint32_t i, int scale) {
  Level& at = level(scale);
  OnlineCell<D>& dead = at.cells[i];
  if (scale + 1 < scales()) {
    std::vector<std::uint32_t>& siblings = cell(dead.parent, scale + 1).children;
    siblings[dead.place] = siblings.back();
    cell(siblings[dead.place], scale).place = dead.place;
    siblings.pop_back();
    markStale(dead.parent, scale + 1);
  }
  at.index.erase(KeyIndex::hashOf(dead.key), i);
  at.clusters -= dead.clusters.size();
  dead.clusters.clear();
  dead.clusters.shrink_to_fit();
  dead.children.clear();
  dead.children.shrink_to_fit();
  dead.alive = dead.stale = false;
  dead.need = dead.spare = 0.0;
  if (scale == 0) moments_[i] = {};
  at.free.push_back(i);
}

template <int D>
void OnlineCells<D>::setClusters(std::uint32_t i, int scale, OnlineClusters<D> clusters) {
  level(scale).clusters += clusters.size();
  level(scale).clusters -= cell(i, scale).clusters.size();
  cell(i, scale).clusters = std::move(clusters);
}

template <int D>
void OnlineCells<D>::addCluster(std::uint32_t i, int scale, const OnlineCluster<D>& cluster) {
  cell(i, scale).clusters.push_back(cluster);
  ++level(scale).clusters;
}

template <int D>
std::vector<Gaussian<D>> OnlineCells<D>::dataUnder(std::uint32_t i, int scale) const {
  std::vector<Gaussian<D>> data;
  for (const std::uint32_t child : cell(i, scale).children) {
    const OnlineCell<D>& finer = cell(child, scale - 1);
    const Vector<D> shift = grid_.centreInParent(finer.key, scale - 1);
    for (const OnlineCluster<D>& cluster : finer.clusters) {
      data.push_back(cluster.gaussian);
      data.back().mean += shift;
    }
  }
  return data;
}

template <int D>
void OnlineCells<D>::refresh(std::uint32_t i, int scale) {
  OnlineCell<D>& coarse = cell(i, scale);
  if (!coarse.stale) return;
  if (scale > 1)
    for (const std::uint32_t child : coarse.children) refresh(child, scale - 1);
  const std::vector<Gaussian<D>> data = dataUnder(i, scale);
  std::vector<std::vector<Gaussian<D>>> members(coarse.clusters.size());
  for (OnlineCluster<D>& cluster : coarse.clusters) cluster.area = 0.0;
  std::size_t next = 0;
  forClustersUnder(i, scale, [&](OnlineCluster<D>& finer) {
    members[finer.parent].push_back(data[next++]);
    coarse.clusters[finer.parent].area += finer.area;
  });
  for (std::size_t c = 0; c < members.size(); ++c)
    if (!members[c].empty()) coarse.clusters[c].gaussian = merge(members[c]);
  coarse.stale = false;
}

template <int D>
void OnlineCells<D>::markStale(std::uint32_t i, int scale) {
  for (; scale < scales() && !cell(i, scale).stale; ++scale) {
    cell(i, scale).stale = true;
    i = cell(i, scale).parent;
  }
}

template <int D>
std::size_t OnlineCells<D>::memoryBytes() const {
  std::size_t bytes = moments_.size() * sizeof(CellMoments<D>);
  for (const Level& at : scales_) {
    bytes +=
        at.cells.size() * sizeof(OnlineCell<D>) + at.free.capacity() * sizeof(std::uint32_t) + at.index.memoryBytes();
    for (const OnlineCell<D>& cell : at.cells)
      bytes +=
          (cell.clusters.capacity() - 1) * sizeof(OnlineCluster<D>) + cell.children.capacity() * sizeof(std::uint32_t);
  }
  return bytes;
}

template class OnlineCells<2>;
template class OnlineCells<3>;

}  // namespace gaussmap::detail
