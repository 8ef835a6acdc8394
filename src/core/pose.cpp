// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/pose.h"

#include <cmath>
#include <sstream>

#include "core/pose_jacobian.h"

namespace gaussmap {
using namespace detail;

namespace {

// Rounding to two decimals changes the norm of a unit quaternion by at most 0.01. Above twice this, rounding is not the
// cause.
constexpr double kRounded = 0.02;

}  // namespace

std::string poseFault(const Pose& pose) {
  std::ostringstream text;
  const Eigen::Vector3d& t = pose.translation;
  const Pose::Rotation& q = pose.rotation;
  const double norm = q.norm();
  if (!t.allFinite()) {
    text << "the translation (" << t.x() << ", " << t.y() << ", " << t.z() << ") is not finite";
  } else if (!q.coeffs().allFinite()) {
    text << "the quaternion (w " << q.w() << ", x " << q.x() << ", y " << q.y() << ", z " << q.z() << ") is not finite";
  } else if (norm == 0.0) {
    text << "the quaternion is zero: use w = 1, x = y = z = 0 for no rotation";
  } else if (!(std::abs(norm - 1.0) <= kQuaternionTolerance)) {
    text << "the quaternion (w " << q.w() << ", x " << q.x() << ", y " << q.y() << ", z " << q.z() << ") has norm "
         << norm << " instead of 1: check the order of its numbers"
         << (std::abs(norm - 1.0) < kRounded ? ", or give more digits" : "");
  }
  return text.str();
}

Pose normalised(const Pose& pose) {
  return {pose.translation, pose.rotation.normalized()};
}

Pose Pose::operator*(const Pose& other) const {
  return {*this * other.translation, (rotation * other.rotation).normalized()};
}

Pose Pose::inverse() const {
  return {-(rotation.toRotationMatrix().transpose() * translation), rotation.conjugate()};
}

PoseCovariance covarianceOfInverse(const Pose& pose, const PoseCovariance& covariance) {
  // An error (dt, dr) of the pose, expressed in the other frame: it is rotated, and moved to the other origin.
  const Eigen::Matrix3d back = pose.rotation.toRotationMatrix().transpose();
  PoseCovariance j = PoseCovariance::Zero();
  j.topRows<3>() = back * poseJacobian(-pose.translation);
  j.bottomRightCorner<3, 3>() = back;
  return j * covariance * j.transpose();
}

}  // namespace gaussmap
