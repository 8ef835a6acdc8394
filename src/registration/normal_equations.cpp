// SPDX-License-Identifier: BSD-3-Clause
#include "registration/normal_equations.h"

#include <Eigen/Geometry>

namespace gaussmap::detail {

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  information += other.information;
  gradient += other.gradient;
  cost += other.cost;
  met += other.met;
  near += other.near;
  near_squared += other.near_squared;
  return *this;
}

Pose moved(const Pose& pose, const NormalEquations::Vector6& by) {
  const Eigen::Vector3d turn = by.tail<3>();
  const double angle = turn.norm();
  Pose result = pose;
  result.translation += by.head<3>();
  if (angle > 0.0)
    result.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * Eigen::Quaterniond(pose.rotation);
  return normalised(result);
}

}  // namespace gaussmap::detail
