// SPDX-License-Identifier: BSD-3-Clause
#include "core/pi.h"
#include "simulation/scene.h"

namespace gaussmap {
using namespace detail;

namespace {

Pose::Rotation turned(double yaw, double pitch, double roll) {
  return Pose::Rotation(Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitY()) *
                        Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitX()));
}

/// From the plan of the hall (floor from (0, 0) to (20, 12), z = 0) to the map. The floor ends up 4 cm above a
/// border between cells, and no wall is parallel to one.
Pose placement() {
  return {{-7.3, -5.1, 0.04}, turned(17.0, 0.0, 0.0)};
}

Pose placed(const Eigen::Vector3d& position, double yaw, double pitch, double roll) {
  const Pose plan = placement();
  return {plan.rotation * position + plan.translation, plan.rotation * turned(yaw, pitch, roll)};
}

}  // namespace

Scene demoScene() {
  Scene plan;
  plan.rectangles = {
      {{0, 0, 0}, {20, 0, 0}, {0, 12, 0}},  // floor
      {{0, 12, 0}, {20, 0, 0}, {0, 0, 4}},  // the long wall
      {{20, 0, 0}, {0, 12, 0}, {0, 0, 4}},  // the short wall, at its right end
  };
  plan.cylinders = {{{9, 7, 0}, {0, 0, 4}, 0.15}};
  return plan.transformed(placement());
}

std::vector<Pose> demoTrajectory() {
  constexpr double kHeight = 1.8;
  return {placed({2.5, 4.0, kHeight}, 0.0, 0.3, -0.2), placed({6.0, 4.2, kHeight}, 4.0, -0.4, 0.3),
          placed({9.5, 4.7, kHeight}, 12.0, 0.2, 0.4), placed({13.0, 6.0, kHeight}, 30.0, -0.1, -0.5),
          placed({15.5, 8.5, kHeight}, 60.0, 0.5, 0.1)};
}

}  // namespace gaussmap
