// SPDX-License-Identifier: BSD-3-Clause
// Compiled without fused multiply-adds, so every machine finds the same neighbours.
#include "merge_neighbours.h"

#include <algorithm>
#include <nanoflann.hpp>
#include <queue>
#include <tuple>

namespace gaussmap::detail {
namespace {

/// Gives nanoflann access to the means of a table.
template <int D>
struct MeansAdaptor {
  const MergeTable<D>& table;
  std::size_t kdtree_get_point_count() const { return table.slots(); }
  double kdtree_get_pt(std::size_t slot, std::size_t axis) const { return table.mean(slot, static_cast<int>(axis)); }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// A pair of clusters and the cost of its merge. The cost is out of date if a version has changed since.
struct Candidate {
  double cost;
  std::uint32_t a, b;  // slots, a < b
  std::uint32_t version_a, version_b;
  /// For std::priority_queue: true if p is served after q.
  friend bool operator<(const Candidate& p, const Candidate& q) {
    return std::tie(q.cost, q.a, q.b) < std::tie(p.cost, p.a, p.b);
  }
};

template <int D>
class NeighbourMerging {
 public:
  NeighbourMerging(MergeHistory<D>& history, std::size_t neighbours)
      : history_(history), table_(history.table), neighbours_(neighbours) {}

  /// Merges until `until` clusters are left or no more pairs are neighbours. The table must be compact before and is
  /// compact afterwards.
  void run(std::size_t until) {
    findNeighbours();
    std::size_t live = table_.slots();
    version_.assign(live, 0);
    for (std::uint32_t a = 0; a < live; ++a)
      for (const std::uint32_t b : near_[a])
        if (a < b) push(a, b);
    while (live > until && !queue_.empty()) {
      const Candidate best = queue_.top();
      queue_.pop();
      if (version_[best.a] != best.version_a || version_[best.b] != best.version_b) continue;
      merge(best.a, best.b, best.cost);
      --live;
    }
    history_.compact();
  }

 private:
  void findNeighbours() {
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, MeansAdaptor<D>>,
                                                     MeansAdaptor<D>, D, std::uint32_t>;
    const MeansAdaptor<D> means{table_};
    Tree tree(D, means, nanoflann::KDTreeSingleIndexAdaptorParams(16));
    tree.buildIndex();
    const std::size_t count = std::min(neighbours_ + 1, table_.slots());  // one more: each slot finds itself
    std::vector<std::uint32_t> found(count);
    std::vector<double> squared_distances(count);
    near_.assign(table_.slots(), {});
    for (std::uint32_t slot = 0; slot < table_.slots(); ++slot) {
      double point[D];
      for (int axis = 0; axis < D; ++axis) point[axis] = table_.mean(slot, axis);
      tree.knnSearch(point, count, found.data(), squared_distances.data());
      for (const std::uint32_t other : found) {
        if (other == slot) continue;
        near_[slot].push_back(other);
        near_[other].push_back(slot);
      }
    }
    for (std::vector<std::uint32_t>& near : near_) sortOnce(near);
  }

  static void sortOnce(std::vector<std::uint32_t>& slots) {
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  }

  void push(std::uint32_t i, std::uint32_t j) {
    const std::uint32_t a = std::min(i, j), b = std::max(i, j);
    queue_.push({table_.cost(a, b), a, b, version_[a], version_[b]});
  }

  void merge(std::uint32_t a, std::uint32_t b, double cost) {
    history_.merge(a, b, cost);
    ++version_[a];
    ++version_[b];
    std::vector<std::uint32_t>& near = near_[a];
    for (const std::uint32_t other : near_[b]) {
      if (other == a) continue;
      near.push_back(other);
      std::replace(near_[other].begin(), near_[other].end(), b, a);
      sortOnce(near_[other]);
    }
    near_[b] = {};
    near.erase(std::remove(near.begin(), near.end(), b), near.end());
    sortOnce(near);
    for (const std::uint32_t other : near) push(a, other);
  }

  MergeHistory<D>& history_;
  MergeTable<D>& table_;
  std::size_t neighbours_;
  std::vector<std::vector<std::uint32_t>> near_;  // per slot, ascending, symmetric
  std::vector<std::uint32_t> version_;            // per slot: number of its merges so far
  std::priority_queue<Candidate> queue_;
};

}  // namespace

template <int D>
void mergeNeighbours(MergeHistory<D>& history, std::size_t neighbours, std::size_t until) {
  while (history.table.slots() > until)
    NeighbourMerging<D>(history, neighbours).run(std::max(until, history.table.slots() / 2));
}

template void mergeNeighbours<2>(MergeHistory<2>&, std::size_t, std::size_t);
template void mergeNeighbours<3>(MergeHistory<3>&, std::size_t, std::size_t);

}  // namespace gaussmap::detail
