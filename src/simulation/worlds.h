// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/core/pose.h"
#include "simulation/blocks.h"
#include "simulation/path.h"
#include "simulation/world.h"

// The built-in worlds: in the map, or in a plan of their own with the pose that turns the plan into the map.
namespace gaussmap::simulation {

TriangleMesh cornerMesh();             ///< map: floor, long wall, short wall, pole, in this order
std::vector<Pose> cornerTrajectory();  ///< map: drives along both walls past the pole, rolling and pitching slightly

Pose streetPlacement();                     ///< of street and avenue
TriangleMesh streetMesh();                  ///< plan
TriangleMesh avenueMesh();                  ///< plan
std::vector<MovingObject> streetTraffic();  ///< plan
std::vector<Eigen::Vector2d> streetPath();  ///< plan

Pose hallPlacement();
TriangleMesh hallMesh();
std::vector<Eigen::Vector2d> hallPath();

Pose planPlacement();
std::vector<Step> planOutline();  ///< plan, with the heights of the walls
std::vector<Eigen::Vector2d> planPath();

// Things to put into them, standing on z = 0 at the origin, looking along x.
TriangleMesh carMesh();
TriangleMesh vanMesh();
TriangleMesh pedestrianMesh();
TriangleMesh treeMesh(double trunk, double crown, unsigned seed);  ///< height of the trunk, radius of the crown [m]
TriangleMesh lampMesh();
TriangleMesh fenceMesh(double length);  ///< along x
TriangleMesh benchMesh();
TriangleMesh shelterMesh();
TriangleMesh tableMesh(double length, double width);
TriangleMesh chairMesh();
TriangleMesh shelfMesh(double length);
TriangleMesh sofaMesh();

/// A piece at a place of the plan, turned by `yaw` [degree].
TriangleMesh placed(const TriangleMesh& mesh, double x, double y, double z, double yaw);

}  // namespace gaussmap::simulation
