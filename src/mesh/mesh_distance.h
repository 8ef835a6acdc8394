// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/mesh/triangle_mesh.h"
#include "mesh/mesh_tree.h"

namespace gaussmap::detail {

/// Exact distances from points to a mesh, to its faces, edges and corners alike. Built once, asked by any thread.
class MeshDistance {
 public:
  /// Throws std::invalid_argument if the mesh has no triangle or a fault (see checkMesh()).
  explicit MeshDistance(const TriangleMesh& mesh);

  /// Distance [m] from a point to the nearest point of the mesh. Throws std::invalid_argument unless the point is
  /// finite and within 1e70 m.
  double distance(const Eigen::Vector3d& point) const;
  /// That nearest point too.
  MeshFoot nearest(const Eigen::Vector3d& point) const;

 private:
  MeshTree tree_;
};

/// For every point its distance to the mesh [m], one frame, n values in the order of the points. `threads` = 0: all;
/// the result is the same to the last bit for any number.
/// Throws std::invalid_argument, naming the index, if a point is not finite; otherwise as MeshDistance.
std::vector<double> meshDistances(const std::vector<Vector<3>>& points, const TriangleMesh& mesh, int threads = 0);
std::vector<double> meshDistances(const std::vector<Vector<3>>& points, const MeshDistance& mesh, int threads = 0);

}  // namespace gaussmap::detail
