// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/core/pose.h"
#include "simulation/blocks.h"
#include "simulation/path.h"
#include "simulation/world.h"

// The built-in worlds. They are given in the map frame, or in a plan frame with the pose that moves the plan
// to the map.
namespace gaussmap::simulation {

TriangleMesh cornerMesh();             ///< map frame: floor, long wall, short wall, pole, in this order
std::vector<Pose> cornerTrajectory();  ///< map frame: along both walls past the pole, with slight roll and pitch

Pose streetPlacement();                     ///< of street and avenue
TriangleMesh streetMesh();                  ///< plan frame
TriangleMesh avenueMesh();                  ///< plan frame
std::vector<MovingObject> streetTraffic();  ///< plan frame
std::vector<Eigen::Vector2d> streetPath();  ///< plan frame

Pose hallPlacement();
TriangleMesh hallMesh();
std::vector<Eigen::Vector2d> hallPath();

Pose planPlacement();
std::vector<Step> planOutline();  ///< plan frame, with the heights of the walls
std::vector<Eigen::Vector2d> planPath();

// Objects for these worlds. They stand on z = 0 at the origin and face along x.
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

/// Returns an object moved to a place of the plan [m] and rotated by `yaw` [degree].
TriangleMesh placed(const TriangleMesh& mesh, double x, double y, double z, double yaw);

}  // namespace gaussmap::simulation
