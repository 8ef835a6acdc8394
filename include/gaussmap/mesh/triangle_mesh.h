// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Surfaces as triangles: the truth that scans and maps are measured against. A triangle without area is legal, it
/// is the segment or the point that is left of it.
struct TriangleMesh {
  using Triangle = std::array<std::uint32_t, 3>;  ///< three vertices, counter-clockwise seen from the open side
  std::vector<Eigen::Vector3d> vertices;          ///< [m]
  std::vector<Triangle> triangles;                ///< indices into `vertices`
};

/// Throws std::invalid_argument, naming the vertex or the triangle, if a vertex is not finite or beyond 1e70 m, or
/// an index is out of range.
GAUSSMAP_API void checkMesh(const TriangleMesh& mesh);

/// Area of all triangles [m^2].
GAUSSMAP_API double surfaceArea(const TriangleMesh& mesh);

/// Adds the triangles of `part` behind those of `whole`. Throws std::length_error beyond 2^32 - 1 vertices.
GAUSSMAP_API void append(TriangleMesh& whole, const TriangleMesh& part);

/// The mesh moved by R p + t. The quaternion must have unit length.
GAUSSMAP_API TriangleMesh transformed(TriangleMesh mesh, const Pose& pose);

/// `count` points on the triangles [m], in the order of the triangles: as many on each as its share of the area says,
/// rounded up or down, at random places. Same mesh + same seed = same points. Throws std::invalid_argument if the mesh
/// has a fault (see checkMesh()) or, for count > 0, no area.
GAUSSMAP_API std::vector<Eigen::Vector3d> sampleSurface(const TriangleMesh& mesh, std::size_t count,
                                                        std::uint64_t seed = 1);

}  // namespace gaussmap
