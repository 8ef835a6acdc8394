// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/version.h"

namespace gaussmap::detail {

/// A cluster of cells: its mean in sides of a finest cell, its number of points, and the Morton code of its first cell.
struct WardCluster {
  double x = 0.0, y = 0.0, z = 0.0;
  double weight = 0.0;
  std::uint64_t code = 0;
};

/// The merges of clusters within groups of neighbours. Clusters of different groups are never merged. To lose few
/// merges by this, a group is as large as possible: the largest octree node with at most kMaxGroup clusters.
///
/// The cost of a merge is that of Ward (1963): w_1 w_2 / (w_1 + w_2) |m_1 - m_2|^2. It is the increase of the sum of
/// squared distances to the means. The constructor computes the complete dendrogram of each group. In each round, it
/// merges all pairs of clusters of which each is the cheapest partner of the other. To find the cheapest partner, costs
/// are compared with 17 bits of the mantissa of a float. If they are equal, the order of the clusters decides, so the
/// result depends on the input only.
class GAUSSMAP_API WardMerges {
 public:
  static constexpr std::size_t kMaxGroup = 64;

  /// The clusters must be sorted by code, and the codes must differ. `bits`: bits of a code per axis.
  WardMerges(const std::vector<WardCluster>& clusters, int bits);

  /// Returns the smallest number of clusters that these merges can leave: the number of groups.
  std::size_t fewest() const { return size_ - merges_.size(); }
  /// Applies the cheapest merges until max(count, fewest()) clusters are left. Returns, per cluster, the number of its
  /// union. The unions are numbered in the order of their first clusters.
  std::vector<std::uint32_t> cut(std::size_t count) const;

  /// A merge of the unions whose first clusters are `first` < `second`.
  struct Merge {
    float cost;
    std::uint32_t first, second;
  };

 private:
  std::size_t size_ = 0;
  std::vector<Merge> merges_;  // group by group; a merge follows the merges of its parts and is not cheaper than they
};

}  // namespace gaussmap::detail
