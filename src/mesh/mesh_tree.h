// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "gaussmap/mesh/triangle_mesh.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// The first hit of a ray on a mesh.
struct MeshHit {
  double range = 0.0;          ///< along the ray [m], > 0
  double cosine = 1.0;         ///< between the ray and the triangle's normal, >= 0
  std::uint32_t triangle = 0;  ///< index in the mesh
};

/// The point of a mesh that is nearest to another point.
struct MeshFoot {
  Eigen::Vector3d point;       ///< the nearest point of the mesh [m]
  double distance = 0.0;       ///< distance to it [m]
  std::uint32_t triangle = 0;  ///< index in the mesh
};

/// A bounding-volume hierarchy over the triangles of a mesh, in doubles. It does not change once it is built, so any
/// number of threads may query it. It does not keep the mesh itself.
class GAUSSMAP_API MeshTree {
 public:
  /// Throws std::invalid_argument if the mesh has a fault (see checkMesh()). An empty mesh is allowed and never hit.
  explicit MeshTree(const TriangleMesh& mesh);

  /// Returns the first hit of the ray origin + r direction with 0 < r <= max_range, from either side; std::nullopt if
  /// there is none. `direction` has unit length. Edges belong to both triangles, so no ray passes between them. A ray
  /// within the plane of a triangle does not hit it, and no ray hits a triangle without area. The relative error of the
  /// range is about 1e-15 divided by the cosine: a ray that grazes a face may end slightly beyond its edge.
  std::optional<MeshHit> intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                   double max_range = std::numeric_limits<double>::infinity()) const;

  /// Returns the nearest point of the mesh. Returns std::nullopt if the mesh is empty, or if the point is not finite or
  /// beyond 1e70 m.
  std::optional<MeshFoot> nearest(const Eigen::Vector3d& point) const;

  std::size_t size() const { return triangles_.size(); }  ///< number of triangles

 private:
  struct Triangle {
    Eigen::Vector3d corner, u, v;  // corner + s u + t v, s and t >= 0, s + t <= 1
    std::uint32_t index;
  };
  struct Node {
    Eigen::Vector3d low, high;
    std::uint32_t first;  // in a leaf its first triangle, else its left child; the right child is the next node
    std::uint32_t count;  // number of triangles in a leaf, else 0
  };
  struct Builder;
  std::vector<Triangle> triangles_;  // those of a leaf are consecutive
  std::vector<Node> nodes_;          // 0 is the root
};

}  // namespace gaussmap::detail
