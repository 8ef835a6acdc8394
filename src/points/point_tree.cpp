// SPDX-License-Identifier: BSD-3-Clause
#include "points/point_tree.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/morton.h"

namespace gaussmap::detail {
namespace {

constexpr double kFarthest = 1e150;   // [m]; squares beyond it would overflow
constexpr double kNoExtent = 1e-200;  // [m]; squares below it are 0

}  // namespace

struct PointTree::Builder {
  const std::vector<Vector<3>>& points;
  std::vector<Node>& nodes;
  MortonItems items, spare;

  void addLeaf(std::size_t first, std::size_t last, std::size_t distinct) {
    nodes.push_back({{}, {}, std::uint32_t(first), std::uint32_t(last - first), 0, std::uint32_t(distinct)});
  }

  /// Builds a tree over any range. First sorts the range by the Morton code within its own box.
  void sortAndSplit(std::size_t first, std::size_t last) {
    Vector<3> low = points[items[first].index], high = low;
    for (std::size_t i = first; i < last; ++i) {
      low = low.cwiseMin(points[items[i].index]);
      high = high.cwiseMax(points[items[i].index]);
    }
    const double extent = (high - low).maxCoeff();
    if (extent < kNoExtent) return addLeaf(first, last, 1);
    const double scale = 2097151.0 / extent;  // 21 bits per axis
    for (std::size_t i = first; i < last; ++i) {
      const Vector<3> offset = scale * (points[items[i].index] - low);
      items[i].code = mortonCode(std::uint64_t(offset.x()), std::uint64_t(offset.y()), std::uint64_t(offset.z()));
    }
    sortByCode(items.data() + first, last - first, spare);
    split(first, last);
  }

  /// Builds a tree over a sorted range. Splits the range at the highest bit in which its codes differ.
  void split(std::size_t first, std::size_t last) {
    if (last - first <= kLeafSize) return addLeaf(first, last, last - first);
    std::uint64_t differing = items[first].code ^ items[last - 1].code;
    if (differing == 0) return sortAndSplit(first, last);  // below the resolution of the code: sort in a smaller box
    for (int shift = 1; shift < 64; shift *= 2) differing |= differing >> shift;
    const std::uint64_t bit = differing ^ differing >> 1;
    const auto middle =
        std::partition_point(items.begin() + std::ptrdiff_t(first), items.begin() + std::ptrdiff_t(last),
                             [bit](const MortonItem& item) { return (item.code & bit) == 0; });
    const std::size_t node = nodes.size(), half = std::size_t(middle - items.begin());
    nodes.push_back({{}, {}, std::uint32_t(first), std::uint32_t(last - first), 0, 0});
    split(first, half);
    nodes[node].right = std::uint32_t(nodes.size());
    split(half, last);
  }
};

PointTree::PointTree(const std::vector<Vector<3>>& points) {
  if (points.empty()) return;
  Builder builder{points, nodes_, MortonItems(points.size()), {}};
  for (std::size_t i = 0; i < points.size(); ++i) builder.items[i].index = std::uint32_t(i);
  nodes_.reserve(points.size() / 4);
  builder.sortAndSplit(0, points.size());

  index_.resize(points.size());
  for (std::vector<double>& axis : axes_) axis.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    index_[i] = builder.items[i].index;
    for (std::size_t a = 0; a < 3; ++a) axes_[a][i] = points[index_[i]](Eigen::Index(a));
  }
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children come after their parents
    Node& node = nodes_[n];
    for (std::size_t a = 0; a < 3; ++a) {
      if (node.right != 0) {
        node.low[a] = std::min(nodes_[n + 1].low[a], nodes_[node.right].low[a]);
        node.high[a] = std::max(nodes_[n + 1].high[a], nodes_[node.right].high[a]);
      } else {
        const auto first = axes_[a].begin() + node.first;
        const auto [low, high] = std::minmax_element(first, first + node.count);
        node.low[a] = *low;
        node.high[a] = *high;
      }
    }
    if (node.right == 0 && node.low == node.high) node.distinct = 1;
  }
}

void checkPoints(const std::vector<Vector<3>>& points, const char* name) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!(points[i].cwiseAbs().array() < kFarthest).all())
      throw std::invalid_argument("point " + std::to_string(i) + " of '" + name +
                                  "' is not finite or farther than 1e150 m");
  if (points.size() > 0xFFFFFFFFu)
    throw std::invalid_argument(std::string("more than 2^32 - 1 points in '") + name + "'");
}

}  // namespace gaussmap::detail
