// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/mesh/triangle_mesh.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// A flat patch: the points corner + s u + t v with s, t in [0, 1].
struct Rectangle {
  Eigen::Vector3d corner;  ///< [m]
  Eigen::Vector3d u;       ///< one edge as a vector [m]
  Eigen::Vector3d v;       ///< the other edge, perpendicular to u [m]
};

/// The curved side of a cylinder, open at both ends.
struct Cylinder {
  Eigen::Vector3d base;  ///< centre of one end [m]
  Eigen::Vector3d axis;  ///< vector from that end to the other [m]
  double radius = 0.0;   ///< [m], > 0
};

// Shapes to build worlds from. append() joins them, transformed() places them.
// Round shapes have flat facets whose corners lie on the true shape. `facets`: number of facets around the shape, >= 3.

/// Maximum number of facets around a shape.
inline constexpr int kMaxFacets = 100000;

/// Returns the smallest number of facets (at most kMaxFacets) that stay within `deviation` of a circle with this
/// radius. All lengths in [m].
GAUSSMAP_API int facetsWithin(double deviation, double radius);

GAUSSMAP_API TriangleMesh rectangleMesh(const Rectangle& rectangle);
/// Returns all six sides of the box between two opposite corners [m].
GAUSSMAP_API TriangleMesh boxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
enum class CylinderEnds { Open, Closed };
GAUSSMAP_API TriangleMesh cylinderMesh(const Cylinder& cylinder, int facets, CylinderEnds ends = CylinderEnds::Open);
/// Returns an ellipsoid with its axes along x, y and z and these radii [m]. It has facets / 2 rows from pole to pole.
GAUSSMAP_API TriangleMesh ellipsoidMesh(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, int facets);

/// Returns a body with the same profile for all y from y_low to y_high, for example a car. The profile lies between the
/// height `bottom` and the line `top` of points (x, z), with ascending x and z >= bottom [m].
GAUSSMAP_API TriangleMesh profileMesh(const std::vector<Eigen::Vector2d>& top, double bottom, double y_low,
                                      double y_high);

}  // namespace gaussmap::detail
