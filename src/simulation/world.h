// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "gaussmap/mesh/triangle_mesh.h"
#include "mesh/mesh_tree.h"

namespace gaussmap {

/// A half-line. The point at range r is origin + r direction.
struct Ray {
  Eigen::Vector3d origin;     ///< [m]
  Eigen::Vector3d direction;  ///< unit length
};

/// A body that moves along a straight line without rotation.
struct MovingObject {
  TriangleMesh mesh;         ///< where it is at time 0 [m], map frame
  Eigen::Vector3d velocity;  ///< [m/s], map frame
};

/// The kind of surface that a ray hit.
enum class SurfaceLabel : std::uint32_t { Static = 0, Moving = 1 };

/// A world whose surfaces are known exactly. Rays hit the triangles of its meshes, so the points of a scan without
/// noise lie on them.
class World {
 public:
  struct Hit {
    double range = 0.0;   ///< along the ray [m], > 0
    double cosine = 1.0;  ///< between the ray and the surface's normal, >= 0
    SurfaceLabel label = SurfaceLabel::Static;
  };

  /// Throws std::invalid_argument if a mesh has a fault (see checkMesh()) or a velocity is not finite.
  explicit World(TriangleMesh mesh, std::vector<MovingObject> moving = {});

  const TriangleMesh& mesh() const { return mesh_; }  ///< everything that does not move
  const std::vector<MovingObject>& moving() const { return moving_; }

  /// Returns the first surface that the ray hits at this time [s], up to max_range [m]; std::nullopt if there is none.
  std::optional<Hit> intersect(const Ray& ray, double time, double max_range) const;

 private:
  TriangleMesh mesh_;
  std::vector<MovingObject> moving_;
  detail::MeshTree tree_;
  std::vector<detail::MeshTree> moving_trees_;
};

}  // namespace gaussmap
