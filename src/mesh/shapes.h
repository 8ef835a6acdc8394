// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/mesh/triangle_mesh.h"

namespace gaussmap::detail {

/// A flat patch: the points corner + s u + t v with s, t in [0, 1].
struct Rectangle {
  Eigen::Vector3d corner;  ///< [m]
  Eigen::Vector3d u;       ///< one edge, its length is the patch's [m]
  Eigen::Vector3d v;       ///< the other edge, at a right angle to u [m]
};

/// The curved side of a cylinder, open at both ends.
struct Cylinder {
  Eigen::Vector3d base;  ///< centre of one end [m]
  Eigen::Vector3d axis;  ///< from that end to the other, its length is the cylinder's [m]
  double radius = 0.0;   ///< [m], > 0
};

// Pieces to build worlds from; put them together with append(), place them with transformed().
// Round shapes have flat facets whose corners lie on the true shape. `facets` = how many go round, >= 3.

/// Most facets that go round a shape.
inline constexpr int kMaxFacets = 100000;

/// Fewest facets (at most kMaxFacets) that stay within `deviation` of a circle of this radius [m].
int facetsWithin(double deviation, double radius);

TriangleMesh rectangleMesh(const Rectangle& rectangle);
/// All six sides of the box between two opposite corners [m].
TriangleMesh boxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
enum class CylinderEnds { Open, Closed };
TriangleMesh cylinderMesh(const Cylinder& cylinder, int facets, CylinderEnds ends = CylinderEnds::Open);
/// An ellipsoid along the axes, `radii` [m] each; facets / 2 from pole to pole.
TriangleMesh ellipsoidMesh(const Eigen::Vector3d& centre, const Eigen::Vector3d& radii, int facets);

/// A body that is the same for every y between two sides: between the height `bottom` and a line of (x, z), x
/// ascending, z >= bottom [m]. A car, for example.
TriangleMesh profileMesh(const std::vector<Eigen::Vector2d>& top, double bottom, double y_low, double y_high);

}  // namespace gaussmap::detail
