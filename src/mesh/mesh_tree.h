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

namespace gaussmap::detail {

/// Where a ray meets a mesh first.
struct MeshHit {
  double range = 0.0;          ///< along the ray [m], > 0
  double cosine = 1.0;         ///< between the ray and the triangle's normal, >= 0
  std::uint32_t triangle = 0;  ///< index in the mesh
};

/// Where a mesh is nearest to a point.
struct MeshFoot {
  Eigen::Vector3d point;       ///< the nearest point of the mesh [m]
  double distance = 0.0;       ///< to it [m]
  std::uint32_t triangle = 0;  ///< index in the mesh
};

/// A bounding-volume hierarchy over the triangles of a mesh, in doubles. Immutable once built, so that any number of
/// threads may ask; the answers do not depend on their number. The mesh itself is not kept.
class MeshTree {
 public:
  /// Throws std::invalid_argument if the mesh has a fault (see checkMesh()). An empty mesh is legal: nothing is hit.
  explicit MeshTree(const TriangleMesh& mesh);

  /// First hit of the ray origin + r direction with 0 < r <= max_range, from either side; nothing if there is none.
  /// `direction` has unit length. Edges belong to both triangles, so that no ray slips through between them; a
  /// ray that runs within a triangle's plane does not meet it, nor does any ray meet a triangle without area. The range
  /// is known to some 1e-15 of it divided by the cosine: a ray that grazes a face may end a bit beyond its edge.
  std::optional<MeshHit> intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                   double max_range = std::numeric_limits<double>::infinity()) const;

  /// Nothing if the mesh is empty, or the point is not finite or beyond 1e70 m.
  std::optional<MeshFoot> nearest(const Eigen::Vector3d& point) const;

  std::size_t size() const { return triangles_.size(); }  ///< triangles

 private:
  struct Triangle {
    Eigen::Vector3d corner, u, v;  // corner + s u + t v, s and t >= 0, s + t <= 1
    std::uint32_t index;
  };
  struct Node {
    Eigen::Vector3d low, high;
    std::uint32_t first;  // of its triangles, or, if it has none of its own, its left child; the right one is next
    std::uint32_t count;  // of its own triangles
  };
  struct Builder;
  std::vector<Triangle> triangles_;  // those of a leaf stand together
  std::vector<Node> nodes_;          // 0 is the root
};

}  // namespace gaussmap::detail
