// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/mesh_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace gaussmap::detail {
namespace {

constexpr std::uint32_t kLeafSize = 4;
constexpr int kBins = 16;
constexpr std::size_t kMaxTriangles = std::size_t{1} << 31;
constexpr int kDeepestByCost = 64;  // deeper nodes are split into halves of equal number, which adds at most 32 levels
constexpr std::size_t kStack = 128;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFarthest = 1e70;      // [m]; fourth powers beyond it would overflow
constexpr double kNeedle = 1e-20;       // squared sine of an angle: a thinner triangle is treated as its three sides
constexpr double kEdge = 1e-12;         // a triangle is hit up to this share of its sides beyond its edges
constexpr double kBoxRounding = 1e-14;  // relative; makes the tests of boxes conservative

struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kInfinity), high = Eigen::Vector3d::Constant(-kInfinity);
  void add(const Eigen::Vector3d& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void add(const Box& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  /// Returns half the surface area [m^2].
  double size() const {
    const Eigen::Vector3d side = high - low;
    return side.x() * side.y() + side.y() * side.z() + side.z() * side.x();
  }
};

/// Returns the range where a ray enters a box [m]; infinity if it misses the box or meets it only beyond `limit`.
double entry(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Eigen::Vector3d& origin,
             const Eigen::Vector3d& inverse, double limit) {
  double in = 0.0, out = limit;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low(axis) - origin(axis)) * inverse(axis), b = (high(axis) - origin(axis)) * inverse(axis);
    // A ray within the plane of a face gives 0 * infinity = NaN, which must not change `in` and `out`.
    const double near = a < b ? a : b, far = a < b ? b : a;
    if (std::isnan(a) || std::isnan(b)) continue;
    in = std::max(in, near);
    out = std::min(out, far);
  }
  return in <= out + kBoxRounding * std::abs(out) ? in : kInfinity;
}

double squaredDistance(const Eigen::Vector3d& low, const Eigen::Vector3d& high, const Eigen::Vector3d& point) {
  return (low - point).cwiseMax(point - high).cwiseMax(0.0).squaredNorm();
}

/// Returns the point of the segment from 0 to `side` that is nearest to `offset`.
Eigen::Vector3d nearestOnSide(const Eigen::Vector3d& side, const Eigen::Vector3d& offset) {
  const double square = side.squaredNorm();
  return square > 0.0 ? Eigen::Vector3d(std::clamp(offset.dot(side) / square, 0.0, 1.0) * side)
                      : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

/// Returns the point of the triangle 0, u, v that is nearest to `offset`. Uses the normal instead of coordinates along
/// u and v, which lose half their digits in a long thin triangle.
Eigen::Vector3d nearestOnTriangle(const Eigen::Vector3d& u, const Eigen::Vector3d& v, const Eigen::Vector3d& offset) {
  const Eigen::Vector3d normal = u.cross(v), third = v - u;
  const double square = normal.squaredNorm();
  if (square > kNeedle * u.squaredNorm() * v.squaredNorm()) {
    Eigen::Vector3d foot = offset - offset.dot(normal) / square * normal;
    if (normal.dot(u.cross(foot)) >= 0.0 && normal.dot(foot.cross(v)) >= 0.0 &&
        normal.dot(third.cross(foot - u)) >= 0.0)
      return foot;
  }
  Eigen::Vector3d best = nearestOnSide(u, offset);
  for (const Eigen::Vector3d& candidate :
       {nearestOnSide(v, offset), Eigen::Vector3d(u + nearestOnSide(third, offset - u))})
    if ((offset - candidate).squaredNorm() < (offset - best).squaredNorm()) best = candidate;
  return best;
}

}  // namespace

/// Builds the tree top-down by the surface-area heuristic, in bins along the longest axis of the centres.
struct MeshTree::Builder {
  struct Item {
    Box box;
    Eigen::Vector3d centre;
    std::uint32_t triangle;
  };

  MeshTree& tree;
  std::vector<Item> items;

  void fill(std::uint32_t node, std::uint32_t first, std::uint32_t last, int depth) {
    Box box, centres;
    for (std::uint32_t i = first; i < last; ++i) {
      box.add(items[i].box);
      centres.add(items[i].centre);
    }
    tree.nodes_[node] = {box.low, box.high, first, last - first};
    if (last - first <= kLeafSize) return;
    const std::uint32_t middle = split(first, last, box, centres, depth);
    const auto left = static_cast<std::uint32_t>(tree.nodes_.size());
    tree.nodes_.resize(tree.nodes_.size() + 2);
    tree.nodes_[node].first = left;
    tree.nodes_[node].count = 0;
    fill(left, first, middle, depth + 1);
    fill(left + 1, middle, last, depth + 1);
  }

  /// Reorders the items and returns where the second part begins. Neither part is empty.
  std::uint32_t split(std::uint32_t first, std::uint32_t last, const Box& box, const Box& centres, int depth) {
    int axis = 0;
    const double extent = (centres.high - centres.low).maxCoeff(&axis);
    const auto begin = items.begin() + first, end = items.begin() + last;
    if (depth < kDeepestByCost && extent > 0.0 && std::isfinite(box.size())) {
      const auto bin = [&](const Item& item) {
        const double part = (item.centre(axis) - centres.low(axis)) / extent;
        return static_cast<std::size_t>(std::clamp(part * kBins, 0.0, double{kBins - 1}));
      };
      const std::size_t cut = bestCut(begin, end, bin);
      const auto middle = std::stable_partition(begin, end, [&](const Item& item) { return bin(item) < cut; });
      if (middle != begin && middle != end) return first + static_cast<std::uint32_t>(middle - begin);
    }
    return first + (last - first) / 2;
  }

  /// Returns the first bin of the right part for the cut with the lowest cost.
  template <typename Iterator, typename Bin>
  static std::size_t bestCut(Iterator begin, Iterator end, const Bin& bin) {
    std::array<Box, kBins> boxes;
    std::array<std::uint32_t, kBins> counts{};
    for (Iterator item = begin; item != end; ++item) {
      boxes[bin(*item)].add(item->box);
      ++counts[bin(*item)];
    }
    std::array<double, kBins> right_cost{};
    Box right;
    double count = 0.0;
    for (std::size_t i = kBins - 1; i > 0; --i) {
      right.add(boxes[i]);
      count += counts[i];
      right_cost[i] = count > 0.0 ? count * right.size() : 0.0;
    }
    Box left;
    count = 0.0;
    double least = kInfinity;
    std::size_t cut = 1;
    for (std::size_t i = 1; i < kBins; ++i) {
      left.add(boxes[i - 1]);
      count += counts[i - 1];
      const double cost = (count > 0.0 ? count * left.size() : 0.0) + right_cost[i];
      if (cost < least) {
        least = cost;
        cut = i;
      }
    }
    return cut;
  }
};

MeshTree::MeshTree(const TriangleMesh& mesh) {
  checkMesh(mesh);
  if (mesh.triangles.empty()) return;
  if (mesh.triangles.size() > kMaxTriangles) throw std::length_error("a tree takes at most 2^31 triangles");
  Builder builder{*this, {}};
  builder.items.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Box box;
    for (const std::uint32_t vertex : mesh.triangles[i]) box.add(mesh.vertices[vertex]);
    builder.items.push_back({box, 0.5 * box.low + 0.5 * box.high, static_cast<std::uint32_t>(i)});
  }
  nodes_.resize(1);
  builder.fill(0, 0, static_cast<std::uint32_t>(builder.items.size()), 0);
  triangles_.reserve(builder.items.size());
  for (const Builder::Item& item : builder.items) {
    const auto [a, b, c] = mesh.triangles[item.triangle];
    const Eigen::Vector3d& corner = mesh.vertices[a];
    triangles_.push_back({corner, mesh.vertices[b] - corner, mesh.vertices[c] - corner, item.triangle});
  }
}

std::optional<MeshHit> MeshTree::intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                           double max_range) const {
  if (nodes_.empty()) return std::nullopt;
  const Eigen::Vector3d inverse = direction.cwiseInverse();
  std::optional<MeshHit> first;
  double limit = max_range;
  const auto meet = [&](const Triangle& triangle) {  // Moeller and Trumbore 1997
    const Eigen::Vector3d p = direction.cross(triangle.v);
    const double determinant = triangle.u.dot(p);
    if (determinant == 0.0) return;
    const Eigen::Vector3d offset = origin - triangle.corner;
    const double s = offset.dot(p) / determinant;
    if (!(s >= -kEdge && s <= 1.0 + kEdge)) return;
    const Eigen::Vector3d q = offset.cross(triangle.u);
    const double t = direction.dot(q) / determinant;
    if (!(t >= -kEdge && s + t <= 1.0 + kEdge)) return;
    const double range = triangle.v.dot(q) / determinant;
    if (!(range > 0.0 && range <= limit)) return;
    if (first && range == first->range && first->triangle < triangle.index) return;
    const double cosine = std::abs(determinant) / triangle.u.cross(triangle.v).norm();
    first = MeshHit{range, std::min(cosine, 1.0), triangle.index};
    limit = range;
  };

  std::array<std::pair<double, std::uint32_t>, kStack> stack;
  std::size_t height = 0;
  stack[height++] = {entry(nodes_[0].low, nodes_[0].high, origin, inverse, limit), 0};
  while (height > 0) {
    const auto [in, index] = stack[--height];
    if (in == kInfinity || in > limit + kBoxRounding * limit) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) meet(triangles_[i]);
      continue;
    }
    std::pair<double, std::uint32_t> children[2];
    for (std::uint32_t side = 0; side < 2; ++side) {
      const Node& child = nodes_[node.first + side];
      children[side] = {entry(child.low, child.high, origin, inverse, limit), node.first + side};
    }
    if (children[0].first < children[1].first) std::swap(children[0], children[1]);  // the nearer one on top
    for (const auto& child : children)
      if (child.first < kInfinity) stack[height++] = child;
  }
  return first;
}

std::optional<MeshFoot> MeshTree::nearest(const Eigen::Vector3d& point) const {
  if (nodes_.empty() || !(point.cwiseAbs().array() < kFarthest).all()) return std::nullopt;
  MeshFoot foot;
  double least = kInfinity;
  std::array<std::pair<double, std::uint32_t>, kStack> stack;
  std::size_t height = 0;
  stack[height++] = {0.0, 0};
  while (height > 0) {
    const auto [square, index] = stack[--height];
    if (square > least + kBoxRounding * least) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Triangle& triangle = triangles_[i];
        const Eigen::Vector3d offset = point - triangle.corner;
        const Eigen::Vector3d on_triangle = nearestOnTriangle(triangle.u, triangle.v, offset);
        const double candidate = (offset - on_triangle).squaredNorm();
        if (!(candidate <= least) || (candidate == least && foot.triangle < triangle.index)) continue;
        least = candidate;
        foot.triangle = triangle.index;
        foot.point = triangle.corner + on_triangle;
      }
      continue;
    }
    std::pair<double, std::uint32_t> children[2];
    for (std::uint32_t side = 0; side < 2; ++side) {
      const Node& child = nodes_[node.first + side];
      children[side] = {squaredDistance(child.low, child.high, point), node.first + side};
    }
    if (children[0].first < children[1].first) std::swap(children[0], children[1]);  // the nearer one on top
    for (const auto& child : children)
      if (child.first <= least + kBoxRounding * least) stack[height++] = child;
  }
  foot.distance = std::sqrt(least);
  return foot;
}

}  // namespace gaussmap::detail
