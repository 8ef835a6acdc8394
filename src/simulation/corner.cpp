// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/shapes.h"
#include "simulation/path.h"
#include "simulation/worlds.h"

namespace gaussmap::simulation {
using namespace detail;

namespace {

/// Returns the pose from the plan (floor from (0, 0) to (20, 12), z = 0) to the map. In the map, the floor lies 4 cm
/// above a border between cells, and no wall is parallel to such a border.
Pose cornerPlacement() {
  return {{-7.3, -5.1, 0.04}, turned(17.0, 0.0, 0.0)};
}

Pose sensorAt(const Eigen::Vector3d& position, double yaw, double pitch, double roll) {
  const Pose plan = cornerPlacement();
  return {plan.rotation * position + plan.translation, plan.rotation * turned(yaw, pitch, roll)};
}

}  // namespace

TriangleMesh cornerMesh() {
  constexpr double kDeviation = 1e-4;  // of the pole's facets from its circle [m]
  const Pose plan = cornerPlacement();
  const Eigen::Matrix3d rotation = plan.rotation.toRotationMatrix();
  const Rectangle rectangles[] = {
      {{0, 0, 0}, {20, 0, 0}, {0, 12, 0}},  // floor
      {{0, 12, 0}, {20, 0, 0}, {0, 0, 4}},  // the long wall
      {{20, 0, 0}, {0, 12, 0}, {0, 0, 4}},  // the short wall, at its right end
  };
  const Cylinder pole{{9, 7, 0}, {0, 0, 4}, 0.15};
  TriangleMesh mesh;
  for (const Rectangle& r : rectangles)
    append(mesh, rectangleMesh({rotation * r.corner + plan.translation, rotation * r.u, rotation * r.v}));
  append(mesh, cylinderMesh({rotation * pole.base + plan.translation, rotation * pole.axis, pole.radius},
                            facetsWithin(kDeviation, pole.radius)));
  return mesh;
}

std::vector<Pose> cornerTrajectory() {
  constexpr double kHeight = 1.8;
  return {sensorAt({2.5, 4.0, kHeight}, 0.0, 0.3, -0.2), sensorAt({6.0, 4.2, kHeight}, 4.0, -0.4, 0.3),
          sensorAt({9.5, 4.7, kHeight}, 12.0, 0.2, 0.4), sensorAt({13.0, 6.0, kHeight}, 30.0, -0.1, -0.5),
          sensorAt({15.5, 8.5, kHeight}, 60.0, 0.5, 0.1)};
}

}  // namespace gaussmap::simulation
