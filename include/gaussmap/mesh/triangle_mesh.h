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

/// Surfaces made of triangles. A mesh can be the ground truth for scans and maps. A triangle without area is valid; it
/// represents a line segment or a point.
struct TriangleMesh {
  using Triangle = std::array<std::uint32_t, 3>;  ///< three vertices, counter-clockwise when seen from free space
  std::vector<Eigen::Vector3d> vertices;          ///< [m]
  std::vector<Triangle> triangles;                ///< each with three indices of `vertices`
};

/// Throws std::invalid_argument if a vertex is not finite or beyond 1e70 m, or if an index is out of range. The message
/// gives the vertex or the triangle.
GAUSSMAP_API void checkMesh(const TriangleMesh& mesh);

/// Returns the area of all triangles [m^2].
GAUSSMAP_API double surfaceArea(const TriangleMesh& mesh);

/// Appends the triangles of `part` to `whole`. Throws std::length_error if there would be more than 2^32 - 1 vertices.
GAUSSMAP_API void append(TriangleMesh& whole, const TriangleMesh& part);

/// Returns the mesh with every vertex p replaced by `R p + t`. The quaternion must have unit length.
GAUSSMAP_API TriangleMesh transformed(TriangleMesh mesh, const Pose& pose);

/// Returns `count` random points on the triangles [m], in the order of the triangles.
///
/// Each triangle gets a number of points proportional to its area, rounded up or down. Same mesh + same seed = same
/// points. Throws std::invalid_argument if the mesh has a fault (see checkMesh()), or if it has no area and count > 0.
GAUSSMAP_API std::vector<Eigen::Vector3d> sampleSurface(const TriangleMesh& mesh, std::size_t count,
                                                        std::uint64_t seed = 1);

}  // namespace gaussmap
