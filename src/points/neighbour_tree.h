// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/huge_pages.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// A tree of bounding boxes over points, for searches of the neighbours of single queries. The points are sorted along
/// a space-filling curve (Morton), which takes a fraction of the time of building a kd-tree. A node has up to four
/// children. The query is compared with all their boxes at once.
///
/// Squared distances are computed in `Scalar`, in the order (x^2 + y^2) + z^2. Rounding is monotonic, so the rounded
/// distance of a box never exceeds that of a point in it. The result is therefore bit-identical to that of a comparison
/// with all points.
template <typename Scalar>
class GAUSSMAP_API NeighbourTree {
 public:
  struct Point {
    std::array<Scalar, 3> at;
    std::uint32_t index;  ///< number by which results identify the point
  };

  NeighbourTree() = default;
  /// The points must be finite. Doubles must be within 1e150, and there must be fewer than 2^31 points.
  explicit NeighbourTree(const std::vector<Point>& points);

  /// Returns the number of points.
  std::size_t size() const { return size_; }

  /// Adds the points within `found.limit()` to `found` (see nearest_list.h), visiting near boxes first. The limit and
  /// all distances are squared [m^2]. The limit can shrink during the search. The query must be finite.
  template <typename Found>
  void search(const std::array<Scalar, 3>& query, Found& found) const {
    if (size_ == 0) return;
    Open few[kFewOpen];
    if (most_open_ <= kFewOpen) return descend(query, found, few);
    std::vector<Open> many(most_open_);
    descend(query, found, many.data());
  }

 private:
  static constexpr std::size_t kLanes = 4;
  static constexpr std::size_t kFewOpen = 128;

  /// Up to four points. Lanes without a point have NaN coordinates, which are never within a limit.
  struct alignas(64) Block {
    Scalar at[3][kLanes];
    std::uint32_t index[kLanes];
  };
  /// A child: if `blocks` is 0, a node with the index `first`; otherwise the blocks `first`, `first` + 1, ...
  struct Child {
    std::uint32_t first;
    std::uint32_t blocks : 31;
    std::uint32_t same : 1;  ///< 1: all points are equal, and sorted by index
  };
  struct Node {
    Scalar low[3][kLanes], high[3][kLanes];
    Child children[kLanes];
    std::uint32_t size;  ///< number of children
  };
  struct Open {
    Scalar square;  ///< squared distance of the query from the box of the child
    Child child;
  };

  template <typename Found>
  void descend(const std::array<Scalar, 3>& query, Found& found, Open* open) const {
    std::size_t count = 0;
    Open next{0, root_};
    while (true) {
      if (next.child.blocks != 0) {
        look(query, next.child, found);
      } else {
        const Node& node = nodes_[next.child.first];
        const Lanes squares = squaredGaps(query, node);
        const Scalar limit = found.limit();
        const std::size_t before = count;
        for (std::size_t i = 0; i < node.size; ++i) {
          const Scalar square = squares(Eigen::Index(i));
          if (!(square <= limit)) continue;
          std::size_t place = count++;  // the nearest child comes last
          for (; place > before && open[place - 1].square < square; --place) open[place] = open[place - 1];
          open[place] = {square, node.children[i]};
        }
      }
      do {
        if (count == 0) return;
        next = open[--count];
      } while (!(next.square <= found.limit()));
    }
  }

  using Lanes = Eigen::Array<Scalar, kLanes, 1>;

  static Eigen::Map<const Lanes> lanes(const Scalar* values) { return Eigen::Map<const Lanes>(values); }

  /// Returns the squared distances of a query from the boxes of all children.
  static Lanes squaredGaps(const std::array<Scalar, 3>& query, const Node& node) {
    const auto gap = [&](std::size_t axis) -> Lanes {
      const Lanes at = Lanes::Constant(query[axis]);
      return (lanes(node.low[axis]) - at).max(at - lanes(node.high[axis])).max(Lanes::Zero());
    };
    const Lanes x = gap(0), y = gap(1), z = gap(2);
    return x * x + y * y + z * z;
  }

  template <typename Found>
  void look(const std::array<Scalar, 3>& query, const Child& child, Found& found) const {
    const Block* const end = blocks_.data() + child.first + child.blocks;
    for (const Block* block = end - child.blocks; block != end; ++block) {
      const Lanes x = query[0] - lanes(block->at[0]), y = query[1] - lanes(block->at[1]),
                  z = query[2] - lanes(block->at[2]);
      const Lanes squares = x * x + y * y + z * z;
      const Scalar limit = found.limit();
      for (std::size_t i = 0; i < kLanes; ++i) {
        const Scalar square = squares(Eigen::Index(i));
        if (square <= limit && !found.add(square, block->index[i]) && child.same) return;
      }
    }
  }

  struct Builder;
  std::vector<Node> nodes_;
  std::vector<Block, PagesAllocator<Block>> blocks_;
  Child root_{0, 0, 0};
  std::size_t size_ = 0;
  std::size_t most_open_ = 0;  ///< upper bound of the number of open children in a search
};

extern template class NeighbourTree<float>;
extern template class NeighbourTree<double>;

}  // namespace gaussmap::detail
