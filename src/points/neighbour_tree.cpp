// SPDX-License-Identifier: BSD-3-Clause
#include "points/neighbour_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/morton.h"

namespace gaussmap::detail {
namespace {

// At most. Measured on scans: with 8 to 16, building and searching take longer.
constexpr std::size_t kPointsPerLeaf = 24;
constexpr double kTinyExtent = 1e-290;  // [m]; the inverse of a smaller extent would overflow

}  // namespace

template <typename Scalar>
struct NeighbourTree<Scalar>::Builder {
  const std::vector<Point>& points;
  NeighbourTree& tree;
  MortonItems items, spare;

  struct Range {
    std::size_t first, last;
    bool sorted;  // by the Morton code
    std::size_t size() const { return last - first; }
  };

  const Point& point(std::size_t i) const { return points[items[i].index]; }

  /// Sorts a range by the Morton code within its own box. Returns false if all points have practically one place.
  bool sort(Range& range) {
    std::array<double, 3> low, high;
    for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = high[axis] = double(point(range.first).at[axis]);
    for (std::size_t i = range.first; i < range.last; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], double(point(i).at[axis]));
        high[axis] = std::max(high[axis], double(point(i).at[axis]));
      }
    const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    if (extent < kTinyExtent) return false;
    const double scale = double((1 << kMortonBits) - 1) / extent;
    for (std::size_t i = range.first; i < range.last; ++i) {
      const auto digit = [&](std::size_t axis) {
        return static_cast<std::uint64_t>(scale * (double(point(i).at[axis]) - low[axis]));
      };
      items[i].code = mortonCode(digit(0), digit(1), digit(2));
    }
    sortByCode(items.data() + range.first, range.size(), spare);
    range.sorted = true;
    return true;
  }

  /// Splits a range at the highest bit in which its codes differ. Returns false if the points cannot be separated.
  bool split(Range& range, Range& right) {
    if (!range.sorted && !sort(range)) return false;
    std::uint64_t differing = items[range.first].code ^ items[range.last - 1].code;
    if (differing == 0) {  // below the resolution of the code: sort in a smaller box
      if (!sort(range)) return false;
      differing = items[range.first].code ^ items[range.last - 1].code;
    }
    for (int shift = 1; shift < 64; shift *= 2) differing |= differing >> shift;
    const std::uint64_t bit = differing ^ differing >> 1;
    const auto middle =
        std::partition_point(items.begin() + std::ptrdiff_t(range.first), items.begin() + std::ptrdiff_t(range.last),
                             [bit](const MortonItem& item) { return (item.code & bit) == 0; });
    right = {std::size_t(middle - items.begin()), range.last, true};
    range.last = right.first;
    return true;
  }

  /// Adds the points of a range as blocks.
  Child addLeaf(const Range& range) {
    Child leaf{static_cast<std::uint32_t>(tree.blocks_.size()),
               static_cast<std::uint32_t>((range.size() + kLanes - 1) / kLanes) & 0x7FFFFFFFu, 0};
    bool same = true;
    for (std::size_t i = range.first; i < range.last; ++i) same = same && point(i).at == point(range.first).at;
    leaf.same = same;
    if (same)
      std::sort(items.begin() + std::ptrdiff_t(range.first), items.begin() + std::ptrdiff_t(range.last),
                [&](const auto& a, const auto& b) { return points[a.index].index < points[b.index].index; });
    for (std::size_t first = range.first; first < range.last; first += kLanes) {
      Block block;
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const bool used = first + lane < range.last;
        for (std::size_t axis = 0; axis < 3; ++axis)
          block.at[axis][lane] = used ? point(first + lane).at[axis] : std::numeric_limits<Scalar>::quiet_NaN();
        block.index[lane] = used ? point(first + lane).index : 0;
      }
      tree.blocks_.push_back(block);
    }
    return leaf;
  }

  /// Builds the tree of a range of at least one point. `open`: children that are open when a search gets here.
  Child build(Range range, std::size_t open) {
    tree.most_open_ = std::max(tree.most_open_, open + kLanes);
    if (range.size() <= kPointsPerLeaf) return addLeaf(range);
    Range parts[kLanes] = {range};
    std::size_t count = 1;
    for (int round = 0; round < 2; ++round)
      for (std::size_t i = count; i-- > 0;)
        if (parts[i].size() > kPointsPerLeaf && split(parts[i], parts[count])) ++count;
    if (count == 1) return addLeaf(range);
    const std::size_t node = tree.nodes_.size();
    tree.nodes_.emplace_back();
    for (std::size_t i = 0; i < count; ++i) {
      const Child child = build(parts[i], open + kLanes - 1);
      tree.nodes_[node].children[i] = child;
    }
    tree.nodes_[node].size = static_cast<std::uint32_t>(count);
    return {static_cast<std::uint32_t>(node), 0, 0};
  }

  /// Computes the boxes of the children of a node whose nodes are complete.
  void fillBoxes(Node& node) const {
    constexpr Scalar kFar = std::numeric_limits<Scalar>::infinity();
    for (std::size_t i = 0; i < kLanes; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Scalar low = kFar, high = -kFar;
        const auto include = [&](Scalar from, Scalar to) {  // NaN is ignored
          low = from < low ? from : low;
          high = to > high ? to : high;
        };
        if (i < node.size && node.children[i].blocks == 0) {
          const Node& child = tree.nodes_[node.children[i].first];
          for (std::size_t k = 0; k < child.size; ++k) include(child.low[axis][k], child.high[axis][k]);
        } else if (i < node.size) {
          for (std::uint32_t b = 0; b < node.children[i].blocks; ++b)
            for (const Scalar at : tree.blocks_[node.children[i].first + b].at[axis]) include(at, at);
        }
        node.low[axis][i] = low;
        node.high[axis][i] = high;
      }
  }
};

template <typename Scalar>
NeighbourTree<Scalar>::NeighbourTree(const std::vector<Point>& points) : size_(points.size()) {
  if (points.empty()) return;
  Builder builder{points, *this, MortonItems(points.size()), {}};
  for (std::size_t i = 0; i < points.size(); ++i) builder.items[i].index = static_cast<std::uint32_t>(i);
  blocks_.reserve(points.size() / 3);
  nodes_.reserve(points.size() / 12);
  root_ = builder.build({0, points.size(), false}, 0);
  for (std::size_t n = nodes_.size(); n-- > 0;) builder.fillBoxes(nodes_[n]);  // children come after their parents
}

template class NeighbourTree<float>;
template class NeighbourTree<double>;

}  // namespace gaussmap::detail
