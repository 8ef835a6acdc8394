// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "core/pi.h"

namespace gaussmap::detail {
namespace {

std::uint32_t addVertex(TriangleMesh& mesh, const Eigen::Vector3d& vertex) {
  mesh.vertices.push_back(vertex);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// Adds two triangles with these four corners, which are counter-clockwise as seen from the open side.
void addQuad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

void checkFacets(int facets) {
  require(facets >= 3 && facets <= kMaxFacets, "facets", facets, "must be 3 to " + std::to_string(kMaxFacets));
}

std::uint32_t next(std::uint32_t i, int facets) {
  return i + 1 == static_cast<std::uint32_t>(facets) ? 0 : i + 1;
}

}  // namespace

int facetsWithin(double deviation, double radius) {
  if (!(deviation > 0.0))
    throw std::invalid_argument("deviation = " + std::to_string(deviation) + ": must be a positive number of metres");
  // The distance between a chord over the angle 2 a and its arc is at most r (1 - cos a).
  const double angle = std::acos(std::max(0.5, 1.0 - deviation / radius));
  return static_cast<int>(std::min(double(kMaxFacets), std::ceil(kPi / angle)));
}

TriangleMesh rectangleMesh(const Rectangle& r) {
  return {{r.corner, r.corner + r.u, r.corner + r.u + r.v, r.corner + r.v}, {{0, 1, 2}, {0, 2, 3}}};
}

TriangleMesh boxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.emplace_back(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                               corner & 4 ? high.z() : low.z());
  addQuad(mesh, 0, 2, 3, 1);  // below
  addQuad(mesh, 4, 5, 7, 6);  // above
  addQuad(mesh, 0, 1, 5, 4);
  addQuad(mesh, 2, 6, 7, 3);
  addQuad(mesh, 0, 4, 6, 2);
  addQuad(mesh, 1, 3, 7, 5);
  return mesh;
}

TriangleMesh cylinderMesh(const Cylinder& cylinder, int facets, CylinderEnds ends) {
  checkFacets(facets);
  const Eigen::Vector3d first = cylinder.axis.unitOrthogonal(), second = cylinder.axis.normalized().cross(first);
  TriangleMesh mesh;
  for (int i = 0; i < facets; ++i) {
    const double angle = 2.0 * kPi * i / facets;
    const Eigen::Vector3d rim = cylinder.base + cylinder.radius * (std::cos(angle) * first + std::sin(angle) * second);
    mesh.vertices.push_back(rim);
    mesh.vertices.emplace_back(rim + cylinder.axis);
  }
  const auto count = static_cast<std::uint32_t>(facets);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = next(i, facets);
    addQuad(mesh, 2 * i, 2 * j, 2 * j + 1, 2 * i + 1);
  }
  if (ends == CylinderEnds::Open) return mesh;
  const std::uint32_t base = addVertex(mesh, cylinder.base), top = addVertex(mesh, cylinder.base + cylinder.axis);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t j = next(i, facets);
    mesh.triangles.push_back({base, 2 * j, 2 * i});
    mesh.triangles.push_back({top, 2 * i + 1, 2 * j + 1});
  }
  return mesh;
}

TriangleMesh ellipsoidMesh(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, int facets) {
  checkFacets(facets);
  const auto round = static_cast<std::uint32_t>(facets), rows = std::max(2u, round / 2);
  TriangleMesh mesh;
  for (std::uint32_t row = 1; row < rows; ++row) {
    const double latitude = kPi * (double(row) / rows - 0.5);
    for (std::uint32_t i = 0; i < round; ++i) {
      const double longitude = 2.0 * kPi * i / round;
      const Eigen::Vector3d unit(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                                 std::sin(latitude));
      mesh.vertices.emplace_back(centre + radii.cwiseProduct(unit));
    }
  }
  const std::uint32_t south = addVertex(mesh, centre - Eigen::Vector3d(0, 0, radii.z()));
  const std::uint32_t north = addVertex(mesh, centre + Eigen::Vector3d(0, 0, radii.z()));
  for (std::uint32_t i = 0; i < round; ++i) {
    const std::uint32_t j = next(i, facets), top = (rows - 2) * round;
    mesh.triangles.push_back({south, j, i});
    for (std::uint32_t row = 0; row + 2 < rows; ++row)
      addQuad(mesh, row * round + i, row * round + j, (row + 1) * round + j, (row + 1) * round + i);
    mesh.triangles.push_back({north, top + i, top + j});
  }
  return mesh;
}

TriangleMesh profileMesh(const std::vector<Eigen::Vector2d>& top, double bottom, double y_low, double y_high) {
  if (top.size() < 2) throw std::invalid_argument("a profile needs at least 2 points");
  TriangleMesh mesh;
  for (const Eigen::Vector2d& point : top)
    for (const double y : {y_low, y_high})
      for (const double z : {bottom, point.y()}) mesh.vertices.emplace_back(point.x(), y, z);
  const auto last = static_cast<std::uint32_t>(4 * (top.size() - 1));
  // i: bottom of the low side, i + 1: its top; i + 2: bottom of the high side, i + 3: its top
  for (std::uint32_t i = 0; i < last; i += 4) {
    addQuad(mesh, i, i + 4, i + 5, i + 1);
    addQuad(mesh, i + 2, i + 3, i + 7, i + 6);
    addQuad(mesh, i + 1, i + 5, i + 7, i + 3);
    addQuad(mesh, i, i + 2, i + 6, i + 4);
  }
  addQuad(mesh, 0, 1, 3, 2);
  addQuad(mesh, last, last + 2, last + 3, last + 1);
  return mesh;
}

}  // namespace gaussmap::detail
