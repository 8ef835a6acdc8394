// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gaussmap::detail {

/// d (moved point) / d (translation, small rotation), in the order of PoseCovariance. `arm` = the moved point relative
/// to the moved origin, R p.
inline Eigen::Matrix<double, 3, 6> poseJacobian(const Eigen::Vector3d& arm) {
  Eigen::Matrix<double, 3, 6> result;
  result << 1, 0, 0, 0, arm.z(), -arm.y(),  //
      0, 1, 0, -arm.z(), 0, arm.x(),        //
      0, 0, 1, arm.y(), -arm.x(), 0;
  return result;
}

}  // namespace gaussmap::detail
