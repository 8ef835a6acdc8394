// SPDX-License-Identifier: BSD-3-Clause
#include "registration/planar_equations.h"

#include <cmath>

namespace gaussmap::detail {

Matrix<2> PlanarPose::rotation() const {
  Matrix<2> matrix;
  matrix << std::cos(heading), -std::sin(heading), std::sin(heading), std::cos(heading);
  return matrix;
}

PlanarPose moved(const PlanarPose& pose, const Eigen::Vector3d& by) {
  return {pose.position + by.head<2>(), pose.heading + by.z()};
}

}  // namespace gaussmap::detail
