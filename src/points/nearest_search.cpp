// SPDX-License-Identifier: BSD-3-Clause
#include "points/nearest_search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace gaussmap::detail {
namespace {

using Node = PointTree::Node;

constexpr std::size_t kGroupSize = 16;      // queries that descend the tree together
constexpr std::size_t kLanes = 4;           // queries are padded to a multiple of this
constexpr std::size_t kGroupsPerTask = 32;  // groups per task
constexpr std::size_t kPatience = 64;       // leaves that a group visits before its queries continue one by one
constexpr std::size_t kForever = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kGuesses = 1000;    // points searched first, to estimate the largest distance
constexpr std::size_t kPartSize = 20000;  // points per task
constexpr double kRounding = 1e-12;       // upper bound of the relative rounding error of a distance

/// Returns the squared distance of two boxes [m^2]. Rounding is monotonic: the result never exceeds the squared
/// distance of two points in the boxes.
double squaredGap(const Node& a, const Node& b) {
  double gap[3];
  for (std::size_t i = 0; i < 3; ++i) gap[i] = std::max(0.0, std::max(a.low[i] - b.high[i], b.low[i] - a.high[i]));
  return gap[0] * gap[0] + gap[1] * gap[1] + gap[2] * gap[2];
}

/// Queries that are close together, and their nearest distances so far.
struct Group {
  Node box{};
  std::size_t count = 0;  // padded to kLanes
  double worst = 0.0;     // largest of `best`
  alignas(64) double at[3][kGroupSize];
  alignas(64) double best[kGroupSize];  // squared distance to the nearest point so far [m^2]

  void fill(const PointTree& tree, std::size_t first, std::size_t size) {
    count = (size + kLanes - 1) / kLanes * kLanes;
    for (std::size_t a = 0; a < 3; ++a) {
      const double* const from = tree.axis(a) + first;
      box.low[a] = box.high[a] = from[0];
      for (std::size_t i = 0; i < count; ++i) {
        at[a][i] = from[i < size ? i : 0];
        box.low[a] = std::min(box.low[a], at[a][i]);
        box.high[a] = std::max(box.high[a], at[a][i]);
      }
    }
    std::fill_n(best, kGroupSize, std::numeric_limits<double>::infinity());
    worst = best[0];
  }

  /// Fills all lanes with one query and its squared distance so far [m^2].
  void fillWithOne(const Vector<3>& query, double square = std::numeric_limits<double>::infinity()) {
    count = kLanes;
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = box.high[a] = query(Eigen::Index(a));
      std::fill_n(at[a], kLanes, query(Eigen::Index(a)));
    }
    std::fill_n(best, kLanes, square);
    worst = square;
  }

  /// Compares the points of a leaf, one after the other, with all queries.
  void look(const PointTree& tree, const Node& leaf) {
    const double* const x = tree.axis(0) + leaf.first;
    const double* const y = tree.axis(1) + leaf.first;
    const double* const z = tree.axis(2) + leaf.first;
    for (std::size_t j = 0; j < leaf.distinct; ++j) {
      const double px = x[j], py = y[j], pz = z[j];
      for (std::size_t i = 0; i < count; ++i) {
        const double dx = at[0][i] - px, dy = at[1][i] - py, dz = at[2][i] - pz;
        const double square = dx * dx + dy * dy + dz * dz;
        best[i] = square < best[i] ? square : best[i];
      }
    }
    worst = *std::max_element(best, best + count);
  }
};

/// Searches a tree for one group of queries after the other.
class Search {
 public:
  explicit Search(const PointTree& tree) : tree_(tree) {}

  /// Number of point pairs compared so far.
  std::size_t comparisons() const { return comparisons_; }

  /// Finds the nearest distance of each query. Stops earlier if all squared distances are at most `enough` [m^2].
  void run(Group& group, double enough) {
    if (go(group, enough, kPatience)) return;
    // The group is spread out and far from the tree's points, so its box is near too many nodes.
    Group alone;
    for (std::size_t i = 0; i < group.count; ++i) {
      alone.fillWithOne({group.at[0][i], group.at[1][i], group.at[2][i]}, group.best[i]);
      go(alone, enough, kForever);
      group.best[i] = alone.best[0];
    }
  }

 private:
  struct Open {
    double square;
    std::uint32_t node;
  };

  /// Returns false if it visited `patience` leaves and has not finished.
  bool go(Group& group, double enough, std::size_t patience) {
    const std::vector<Node>& nodes = tree_.nodes();
    open_.clear();
    open_.push_back({0.0, 0});
    while (!open_.empty()) {
      const Open next = open_.back();
      open_.pop_back();
      if (next.square >= group.worst) continue;
      std::uint32_t at = next.node;
      double square = next.square;
      while (nodes[at].right != 0 && square < group.worst) {
        std::uint32_t near = at + 1, far = nodes[at].right;
        double near_square = squaredGap(group.box, nodes[near]), far_square = squaredGap(group.box, nodes[far]);
        if (far_square < near_square) {
          std::swap(near, far);
          std::swap(near_square, far_square);
        }
        if (far_square < group.worst) open_.push_back({far_square, far});
        at = near;
        square = near_square;
      }
      if (square >= group.worst) continue;
      if (patience-- == 0) return false;
      group.look(tree_, nodes[at]);
      comparisons_ += group.count * nodes[at].distinct;
      if (group.worst <= enough) return true;
    }
    return true;
  }

  const PointTree& tree_;
  std::vector<Open> open_;
  std::size_t comparisons_ = 0;
};

struct Range {
  std::uint32_t first, count;
};

/// Returns the largest nodes with at most `size` points, and the leaves with more.
std::vector<std::uint32_t> nodesOf(const PointTree& tree, std::size_t size) {
  std::vector<std::uint32_t> chosen;
  std::size_t done = 0;  // points
  for (std::uint32_t n = 0; n < tree.nodes().size(); ++n) {
    const Node& node = tree.nodes()[n];
    if (node.first < done || (node.right != 0 && node.count > size)) continue;
    chosen.push_back(n);
    done = std::size_t{node.first} + node.count;
  }
  return chosen;
}

/// Returns all points of a tree in groups of neighbours. Many equal points are divided into several groups.
std::vector<Range> groupsOf(const PointTree& tree) {
  std::vector<Range> groups;
  for (const std::uint32_t n : nodesOf(tree, kGroupSize)) {
    const Node& node = tree.nodes()[n];
    for (std::uint32_t first = 0; first < node.count; first += kGroupSize)
      groups.push_back({node.first + first, std::min<std::uint32_t>(kGroupSize, node.count - first)});
  }
  return groups;
}

}  // namespace

PointTreePair::PointTreePair(const std::vector<Vector<3>>& a, const std::vector<Vector<3>>& b, int threads) {
  parallelFor(2, threads, 1, [&](std::size_t i) { trees_[i] = std::make_unique<PointTree>(i == 0 ? a : b); });
}

std::vector<double> nearestDistances(const PointTree& from, const PointTree& to, int threads,
                                     std::size_t* comparisons) {
  const std::vector<Range> groups = groupsOf(from);
  std::vector<double> distances(from.size());
  std::atomic<std::size_t> all_comparisons{0};
  parallelFor((groups.size() + kGroupsPerTask - 1) / kGroupsPerTask, threads, 1, [&](std::size_t task) {
    Search search(to);
    Group group;
    const std::size_t last = std::min(groups.size(), (task + 1) * kGroupsPerTask);
    for (std::size_t g = task * kGroupsPerTask; g < last; ++g) {
      group.fill(from, groups[g].first, groups[g].count);
      search.run(group, -1.0);
      for (std::size_t i = 0; i < groups[g].count; ++i)
        distances[from.index()[groups[g].first + i]] = std::sqrt(group.best[i]);
    }
    all_comparisons += search.comparisons();
  });
  if (comparisons != nullptr) *comparisons = all_comparisons;
  return distances;
}

namespace {

/// A maximum that several threads can raise.
class Largest {
 public:
  void add(double value) {
    double known = value_.load(std::memory_order_relaxed);
    while (known < value && !value_.compare_exchange_weak(known, value, std::memory_order_relaxed)) {
    }
  }
  double get() const { return value_.load(std::memory_order_relaxed); }

 private:
  std::atomic<double> value_{0.0};
};

/// Raises `largest` to the largest squared nearest distance of the points of one tree to those of the other [m^2].
/// Skips single points, and whole boxes of points, that are known to stay below it.
class LargestSearch {
 public:
  LargestSearch(const PointTree& from, const PointTree& to, Largest& largest)
      : from_(from), search_(to), largest_(largest) {}

  void below(std::uint32_t at) {
    const Node& node = from_.nodes()[at];
    if (cannotMatter(node)) return;
    if (node.right != 0 && node.count > kGroupSize) {
      below(at + 1);
      below(node.right);
      return;
    }
    const std::uint32_t distinct = node.right == 0 ? node.distinct : node.count;
    for (std::uint32_t first = 0; first < distinct; first += kGroupSize)
      look({node.first + first, std::min<std::uint32_t>(kGroupSize, distinct - first)});
  }

  std::size_t comparisons() const { return search_.comparisons(); }

  void look(const Range& range) {
    group_.fill(from_, range.first, range.count);
    search_.run(group_, largest_.get());
    largest_.add(*std::max_element(group_.best, group_.best + group_.count));
  }

 private:
  /// Returns true if no point of the node can raise `largest`. The distance of a point to the other tree is at most the
  /// distance of the box's centre plus half the box's diagonal.
  bool cannotMatter(const Node& node) {
    Vector<3> centre, half;
    for (std::size_t a = 0; a < 3; ++a) {
      centre(Eigen::Index(a)) = 0.5 * (node.low[a] + node.high[a]);
      half(Eigen::Index(a)) = std::max(node.high[a] - centre(Eigen::Index(a)), centre(Eigen::Index(a)) - node.low[a]);
    }
    const double room = (1.0 - kRounding) * std::sqrt(largest_.get()) - half.norm();
    if (!(room > 0.0)) return false;
    group_.fillWithOne(centre);
    search_.run(group_, room * room);
    return group_.best[0] <= room * room;
  }

  const PointTree& from_;
  Search search_;
  Largest& largest_;
  Group group_;
};

}  // namespace

double largestNearestDistance(const PointTree& from, const PointTree& to, int threads, std::size_t* comparisons) {
  Largest largest;
  LargestSearch first_guess(from, to, largest);
  const std::size_t step = std::max<std::size_t>(1, from.size() / kGuesses);
  for (std::size_t i = 0; i < from.size(); i += step) first_guess.look({std::uint32_t(i), 1});
  const std::vector<std::uint32_t> parts = nodesOf(from, kPartSize);
  std::atomic<std::size_t> all_comparisons{first_guess.comparisons()};
  parallelFor(parts.size(), threads, 1, [&](std::size_t i) {
    LargestSearch search(from, to, largest);
    search.below(parts[i]);
    all_comparisons += search.comparisons();
  });
  if (comparisons != nullptr) *comparisons = all_comparisons;
  return std::sqrt(largest.get());
}

}  // namespace gaussmap::detail
