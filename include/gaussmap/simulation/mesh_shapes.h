// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/evaluation/triangle_mesh.h"
#include "gaussmap/simulation/scene.h"

namespace gaussmap {

// Pieces to build worlds from; put them together with append(), place them with transformed().
// Round shapes have flat facets whose corners lie on the true shape. `facets` = how many go round, >= 3.

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

/// All surfaces of a scene. A facet is nowhere farther than `deviation` [m] from its cylinder.
/// Throws std::invalid_argument on unusable scenes (see checkScene()), or unless deviation > 0.
TriangleMesh triangulate(const Scene& scene, double deviation = 1e-4);

}  // namespace gaussmap
