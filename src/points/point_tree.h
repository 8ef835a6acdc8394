// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Points in the order of a space-filling curve (Morton), under a binary tree of tight boxes. The tree is searched, and
/// its order is also a good order of queries, because consecutive points are neighbours in space. All coordinates are
/// doubles. The same points in the same order give the same tree.
class GAUSSMAP_API PointTree {
 public:
  static constexpr std::size_t kLeafSize =
      12;  // measured on scans, surfaces and volumes of 10^6 points: 8 to 16 are equally fast

  struct Node {
    std::array<double, 3> low, high;  // [m]
    std::uint32_t first, count;       // range of its points
    std::uint32_t right;              // index of its second child, 0 in a leaf; the first child is the next node
    std::uint32_t distinct;           // in a leaf: number of its first points to compare, 1 if all are equal
  };

  /// Points must be finite, within 1e150 m and fewer than 2^32; see checkPoints().
  explicit PointTree(const std::vector<Vector<3>>& points);

  const std::vector<Node>& nodes() const { return nodes_; }  ///< node 0 is the root; empty without points
  std::size_t size() const { return index_.size(); }
  const double* axis(std::size_t a) const { return axes_[a].data(); }  ///< coordinates in the order of the tree [m]
  const std::uint32_t* index() const { return index_.data(); }         ///< original index of each point

 private:
  struct Builder;
  std::vector<Node> nodes_;
  std::array<std::vector<double>, 3> axes_;
  std::vector<std::uint32_t> index_;
};

/// Throws std::invalid_argument, with the index, if a point is not finite or farther than 1e150 m, or if there are too
/// many points. `name`: name of the set for the message.
GAUSSMAP_API void checkPoints(const std::vector<Vector<3>>& points, const char* name);

}  // namespace gaussmap::detail
