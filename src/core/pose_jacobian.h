// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gaussmap::detail {

/// Returns the derivative of a transformed point with respect to (translation, small rotation), in the order of
/// PoseCovariance. `arm` is the transformed point relative to the transformed origin, R p.
inline Eigen::Matrix<double, 3, 6> poseJacobian(const Eigen::Vector3d& arm) {
  Eigen::Matrix<double, 3, 6> result;
  result << 1, 0, 0, 0, arm.z(), -arm.y(),  //
      0, 1, 0, -arm.z(), 0, arm.x(),        //
      0, 0, 1, arm.y(), -arm.x(), 0;
  return result;
}

}  // namespace gaussmap::detail
