// SPDX-License-Identifier: BSD-3-Clause
#include "core/ellipsoid_pose.h"

namespace gaussmap::detail {

Vector<3> EllipsoidPose::normal() const {
  Vector<3> axis = rotation * Vector<3>::UnitX();
  constexpr double kNone = 1e-12;  // components below this are rounding errors of 0
  for (const int i : {2, 1, 0})
    if (std::abs(axis(i)) > kNone) return axis(i) > 0.0 ? axis : Vector<3>(-axis);
  return axis;
}

EllipsoidPose ellipsoidPose(const Gaussian<3>& gaussian) {
  const PrincipalAxes<3> axes = principalAxes<3>(gaussian);
  Matrix<3> turn = axes.directions;
  if (turn.determinant() < 0.0) turn.col(0) = -turn.col(0);  // the eigenvectors can form a reflection
  Eigen::Quaternion<double, Eigen::DontAlign> rotation(turn);
  if (rotation.w() < 0.0) rotation.coeffs() = -rotation.coeffs();
  return {rotation.normalized(), axes.variances.cwiseMax(0.0).cwiseSqrt()};
}

}  // namespace gaussmap::detail
