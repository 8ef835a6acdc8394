// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gaussmap/core/gaussian.h"
#include "mesh/mesh_tree.h"

// Meshes for tests, and functions that answer the same questions without a tree and in another way.
namespace gaussmap::test {
using namespace detail;

/// Returns the triangle (0, 0), (4, 0), (0, 3) in the plane z = 0.
inline TriangleMesh oneTriangle() {
  return {{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}}, {{0, 1, 2}}};
}

inline Eigen::Vector3d randomPoint(Random& random, double size) {
  return size * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}

/// Returns triangles of very different sizes. Every tenth has no area.
inline TriangleMesh randomMesh(std::uint64_t seed, std::size_t triangles, const Eigen::Vector3d& offset = {0, 0, 0}) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const Eigen::Vector3d centre = offset + randomPoint(random, 5.0);
    const double size = std::exp(2.0 * random.normal() - 1.5);
    for (int corner = 0; corner < 3; ++corner) mesh.vertices.emplace_back(centre + randomPoint(random, size));
    if (i % 10 == 3) mesh.vertices.back() = mesh.vertices[3 * i];
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

inline double distanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double length = (b - a).norm();
  if (length == 0.0) return (p - a).norm();
  const Eigen::Vector3d along = (b - a) / length;
  return (p - a - std::clamp(along.dot(p - a), 0.0, length) * along).norm();
}

/// Returns the distance to a triangle. Uses the foot of the point on the plane; the signs of three cross products tell
/// whether the foot is inside.
inline double distanceToTriangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c) {
  const double edges = std::min({distanceToSegment(p, a, b), distanceToSegment(p, b, c), distanceToSegment(p, c, a)});
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  if (!normal.allFinite() || normal.isZero()) return edges;
  const Eigen::Vector3d foot = p - normal.dot(p - a) * normal;
  const auto isLeft = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return (to - from).cross(foot - from).dot(normal) >= 0.0;
  };
  return isLeft(a, b) && isLeft(b, c) && isLeft(c, a) ? std::abs(normal.dot(p - a)) : edges;
}

inline double slowDistance(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles)
    least = std::min(least, distanceToTriangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  return least;
}

/// The first hit of a ray, from the plane and the signs of three volumes. `edge` is the distance of the hit from the
/// nearest edge; near an edge, both results are acceptable.
struct SlowHit {
  double range = std::numeric_limits<double>::infinity();
  double edge = 0.0;
};
inline SlowHit slowHit(const TriangleMesh& mesh, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  SlowHit first;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]],
                          &c = mesh.vertices[triangle[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double approach = normal.dot(direction), range = normal.dot(a - origin) / approach;
    if (!(range > 0.0 && range < first.range)) continue;
    const Eigen::Vector3d hit = origin + range * direction;
    const auto side = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      return (to - from).cross(hit - from).dot(normal);
    };
    if (side(a, b) < 0.0 || side(b, c) < 0.0 || side(c, a) < 0.0) continue;
    first = {range,
             std::min({distanceToSegment(hit, a, b), distanceToSegment(hit, b, c), distanceToSegment(hit, c, a)})};
  }
  return first;
}

}  // namespace gaussmap::test
