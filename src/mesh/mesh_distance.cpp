// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/mesh_distance.h"

#include <stdexcept>
#include <string>

#include "core/parallel.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kGrain = 512;  // points per task

const TriangleMesh& notEmpty(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw std::invalid_argument("the mesh has no triangles: distances need at least one");
  return mesh;
}

}  // namespace

MeshDistance::MeshDistance(const TriangleMesh& mesh) : tree_(notEmpty(mesh)) {}

MeshFoot MeshDistance::nearest(const Eigen::Vector3d& point) const {
  const std::optional<MeshFoot> foot = tree_.nearest(point);
  if (!foot) throw std::invalid_argument("distance to a mesh: the point is not finite or farther than 1e70 m");
  return *foot;
}

double MeshDistance::distance(const Eigen::Vector3d& point) const {
  return nearest(point).distance;
}

std::vector<double> meshDistances(const std::vector<Vector<3>>& points, const MeshDistance& mesh, int threads) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      throw std::invalid_argument("meshDistances: point " + std::to_string(i) + " is not finite");
  std::vector<double> distances(points.size());
  parallelFor(points.size(), threads, kGrain, [&](std::size_t i) { distances[i] = mesh.distance(points[i]); });
  return distances;
}

std::vector<double> meshDistances(const std::vector<Vector<3>>& points, const TriangleMesh& mesh, int threads) {
  return meshDistances(points, MeshDistance(mesh), threads);
}

}  // namespace gaussmap::detail
