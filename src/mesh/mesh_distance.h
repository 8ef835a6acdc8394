// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/mesh/triangle_mesh.h"
#include "gaussmap/version.h"
#include "mesh/mesh_tree.h"

namespace gaussmap::detail {

/// Computes exact distances from points to a mesh, that is to its faces, edges and corners. It is built once, and any
/// thread may query it.
class GAUSSMAP_API MeshDistance {
 public:
  /// Throws std::invalid_argument if the mesh has no triangle or a fault (see checkMesh()).
  explicit MeshDistance(const TriangleMesh& mesh);

  /// Returns the distance [m] from a point to the nearest point of the mesh. Throws std::invalid_argument unless the
  /// point is finite and within 1e70 m.
  double distance(const Eigen::Vector3d& point) const;
  /// Like distance(), but also returns the nearest point and its triangle.
  MeshFoot nearest(const Eigen::Vector3d& point) const;

 private:
  MeshTree tree_;
};

/// Returns the distance of each point to the mesh [m]: n values in the order of the points. Points and mesh are in one
/// frame. `threads`: 0 = all cores.
/// Throws std::invalid_argument, with the index, if a point is not finite; otherwise like MeshDistance.
GAUSSMAP_API std::vector<double> meshDistances(const std::vector<Vector<3>>& points, const TriangleMesh& mesh,
                                               int threads = 0);
GAUSSMAP_API std::vector<double> meshDistances(const std::vector<Vector<3>>& points, const MeshDistance& mesh,
                                               int threads = 0);

}  // namespace gaussmap::detail
