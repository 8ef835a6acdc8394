// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/mesh/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
namespace {

constexpr double kFarthestVertex = 1e70;  // [m]; fourth powers beyond it would overflow

double area(const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  return 0.5 * (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).norm();
}

}  // namespace

void checkMesh(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!(mesh.vertices[i].cwiseAbs().array() < kFarthestVertex).all())
      throw std::invalid_argument("vertex " + std::to_string(i) + " of the mesh is not finite or farther than 1e70 m");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t index : mesh.triangles[i])
      if (index >= mesh.vertices.size())
        throw std::invalid_argument("triangle " + std::to_string(i) + " of the mesh has vertex index " +
                                    std::to_string(index) + ", but the number of vertices is " +
                                    std::to_string(mesh.vertices.size()));
}

double surfaceArea(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) sum += area(mesh, triangle);
  return sum;
}

void append(TriangleMesh& whole, const TriangleMesh& part) {
  const std::size_t first = whole.vertices.size(), triangles = part.triangles.size();
  if (part.vertices.size() > std::numeric_limits<std::uint32_t>::max() - first)
    throw std::length_error("a mesh holds at most 2^32 - 1 vertices");
  whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
  const auto shift = static_cast<std::uint32_t>(first);
  for (std::size_t i = 0; i < triangles; ++i) {
    const TriangleMesh::Triangle t = part.triangles[i];
    whole.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
}

TriangleMesh transformed(TriangleMesh mesh, const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  for (Eigen::Vector3d& vertex : mesh.vertices) vertex = (rotation * vertex + pose.translation).eval();
  return mesh;
}

std::vector<Eigen::Vector3d> sampleSurface(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  checkMesh(mesh);
  if (count == 0) return {};
  std::vector<double> area_up_to;
  area_up_to.reserve(mesh.triangles.size());
  double sum = 0.0;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) area_up_to.push_back(sum += area(mesh, triangle));
  if (!(sum > 0.0 && std::isfinite(sum))) throw std::invalid_argument("the mesh has no area to sample");

  // Takes equal steps along the summed area, from one random offset. Each triangle gets its share, rounded up or down.
  Random random(seed);
  const double offset = random.uniform();
  std::vector<Eigen::Vector3d> points;
  points.reserve(count);
  std::size_t triangle = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = (static_cast<double>(i) + offset) / static_cast<double>(count) * sum;
    while (triangle + 1 < area_up_to.size() && area_up_to[triangle] <= place) ++triangle;
    const auto& [a, b, c] = mesh.triangles[triangle];
    const Eigen::Vector3d& corner = mesh.vertices[a];
    const double root = std::sqrt(random.uniform()), part = random.uniform();
    points.emplace_back(corner + root * (1.0 - part) * (mesh.vertices[b] - corner) +
                        root * part * (mesh.vertices[c] - corner));
  }
  return points;
}

}  // namespace gaussmap
