// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "merge_table.h"

namespace gaussmap::detail {

/// The remaining clusters and the merges made so far. Slots stay ordered by the smallest input index of their clusters:
/// of two slots that merge, the first one stays.
template <int D>
struct MergeHistory {
  MergeHistory(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas, MergeCost cost)
      : table(data, areas, cost), node(data.size()) {
    dendrogram.size = data.size();
    dendrogram.merges.reserve(data.empty() ? 0 : data.size() - 1);
    for (std::size_t j = 0; j < node.size(); ++j) node[j] = static_cast<std::uint32_t>(j);
  }

  /// Merges slots a < b.
  void merge(std::size_t a, std::size_t b, double cost) {
    table.unite(a, b);
    dendrogram.merges.push_back({node[a], node[b], cost});
    node[a] = static_cast<std::uint32_t>(dendrogram.size + dendrogram.merges.size() - 1);
    node[b] = kGone;
  }

  /// Removes the gaps and returns the old slots of 0, 1, ...
  std::vector<std::uint32_t> compact() {
    std::vector<std::uint32_t> kept;
    for (std::size_t slot = 0; slot < node.size(); ++slot)
      if (node[slot] != kGone) kept.push_back(static_cast<std::uint32_t>(slot));
    for (std::size_t slot = 0; slot < kept.size(); ++slot) node[slot] = node[kept[slot]];
    node.resize(kept.size());
    table.keep(kept);
    return kept;
  }

  static constexpr std::uint32_t kGone = 0xFFFFFFFFu;
  MergeTable<D> table;
  std::vector<std::uint32_t> node;  // per slot: its node of the dendrogram
  Dendrogram dendrogram;
};

/// Merges until `until` clusters are left. A pair is a candidate only if one of its clusters is among the `neighbours`
/// nearest clusters of the other, by their means. A merged cluster inherits the neighbours of both. The neighbours are
/// searched again each time half of the clusters are gone. The table is compact afterwards.
template <int D>
void mergeNeighbours(MergeHistory<D>& history, std::size_t neighbours, std::size_t until);

}  // namespace gaussmap::detail
