// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/budget_by_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "mesh/mesh_distance.h"

namespace gaussmap::benchmark {
using namespace detail;

namespace {

/// Returns the unit normal of a triangle, or zero if it has no area.
Vector<3> normalOf(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vector<3> cross = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
  const double area = cross.norm();
  return area > 0.0 ? Vector<3>(cross / area) : Vector<3>(Vector<3>::Zero());
}

/// The triangles of a mesh, each in all boxes of a grid that its surroundings of one radius meet.
class NearbyTriangles {
 public:
  NearbyTriangles(const TriangleMesh& mesh, double radius) : side_(2.0 * radius) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      TriangleMesh one;
      for (const std::uint32_t vertex : mesh.triangles[t]) one.vertices.push_back(mesh.vertices[vertex]);
      one.triangles = {{0, 1, 2}};
      const Vector<3>&a = one.vertices[0], &b = one.vertices[1], &c = one.vertices[2];
      const MeshTree& tree = trees_.emplace_back(one);
      const double reach = radius + 0.5 * std::sqrt(3.0) * side_;
      const Key low = keyOf(a.cwiseMin(b).cwiseMin(c).array() - radius),
                high = keyOf(a.cwiseMax(b).cwiseMax(c).array() + radius);
      for (int x = low[0]; x <= high[0]; ++x)
        for (int y = low[1]; y <= high[1]; ++y)
          for (int z = low[2]; z <= high[2]; ++z)
            if (tree.nearest(side_ * Vector<3>(x + 0.5, y + 0.5, z + 0.5))->distance <= reach)
              boxes_[{x, y, z}].push_back(t);
    }
  }

  /// Returns all triangles that may be within the radius of a point.
  const std::vector<std::uint32_t>& near(const Vector<3>& point) const {
    static const std::vector<std::uint32_t> kNone;
    const auto found = boxes_.find(keyOf(point));
    return found == boxes_.end() ? kNone : found->second;
  }
  /// Returns the point of a triangle that is nearest to a point.
  MeshFoot footOn(std::uint32_t triangle, const Vector<3>& point) const { return *trees_[triangle].nearest(point); }

 private:
  using Key = std::array<int, 3>;
  Key keyOf(const Vector<3>& point) const {
    const auto along = [&](int axis) { return static_cast<int>(std::floor(point(axis) / side_)); };
    return {along(0), along(1), along(2)};
  }

  double side_;
  std::vector<MeshTree> trees_;  // one per triangle
  std::map<Key, std::vector<std::uint32_t>> boxes_;
};

}  // namespace

std::vector<SurfaceKind> surfaceKinds(const std::vector<Vector<3>>& points, const TriangleMesh& mesh,
                                      const SurfaceKindOptions& options) {
  const MeshDistance surface(mesh);
  const NearbyTriangles triangles(mesh, options.radius);
  const double least_cosine = std::cos(options.angle_deg * std::acos(-1.0) / 180.0);
  std::vector<SurfaceKind> kinds;
  kinds.reserve(points.size());
  for (const Vector<3>& point : points) {
    const MeshFoot foot = surface.nearest(point);
    const Vector<3> normal = normalOf(mesh, foot.triangle);
    const auto isOffPlane = [&](std::uint32_t triangle) {
      const MeshFoot other = triangles.footOn(triangle, foot.point);
      if (other.distance > options.radius) return false;
      return std::abs(normal.dot(other.point - foot.point)) > options.tolerance ||
             !(std::abs(normal.dot(normalOf(mesh, triangle))) >= least_cosine);
    };
    const std::vector<std::uint32_t>& near = triangles.near(foot.point);
    const bool is_flat = std::none_of(near.begin(), near.end(), isOffPlane);
    kinds.push_back(is_flat ? SurfaceKind::Flat : SurfaceKind::Detail);
  }
  return kinds;
}

BudgetBySurface budgetBySurface(const GaussianMap<3>& map, int scale, const TriangleMesh& mesh,
                                const SurfaceKindOptions& options) {
  if (scale < 0 || scale >= map.scales())
    throw std::out_of_range("scale " + std::to_string(scale) + ": the map has the scales 0 to " +
                            std::to_string(map.scales() - 1));
  if (map.isCompressed()) throw std::invalid_argument("a compressed map has no finest Gaussians under some cells");
  std::vector<Vector<3>> means;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) means.push_back(map.gaussian(i, 0).mean);
  const std::vector<SurfaceKind> kinds = surfaceKinds(means, mesh, options);

  std::vector<std::array<std::size_t, 2>> finest(map.gaussianCount(scale));  // per Gaussian: flat and detail under it
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    std::size_t ancestor = i;
    for (int s = 0; s < scale; ++s) ancestor = map.parentOf(ancestor, s);
    ++finest[ancestor][kinds[i] == SurfaceKind::Flat ? 0 : 1];
  }
  BudgetBySurface result;
  const double finest_area = map.grid().side(0) * map.grid().side(0);
  for (std::size_t cell = 0; cell < map.cellCount(scale); ++cell) {
    const IndexRange gaussians = map.gaussiansOf(cell, scale);
    std::array<std::size_t, 2> in_cell{};
    for (std::size_t i = gaussians.first; i < gaussians.last; ++i) {
      ++(finest[i][0] >= finest[i][1] ? result.flat : result.detail).gaussians;
      for (std::size_t kind = 0; kind < 2; ++kind) in_cell[kind] += finest[i][kind];
    }
    for (std::size_t kind = 0; kind < 2; ++kind) {
      SurfaceBudget& budget = kind == 0 ? result.flat : result.detail;
      if (in_cell[kind] > 0) ++budget.cells;
      budget.area += finest_area * static_cast<double>(in_cell[kind]);
    }
  }
  return result;
}

}  // namespace gaussmap::benchmark
