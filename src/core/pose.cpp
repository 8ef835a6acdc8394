// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/pose.h"

#include <cmath>
#include <sstream>

namespace gaussmap {

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
    text << "the quaternion is zero: no rotation is w = 1, x = y = z = 0";
  } else if (!(std::abs(norm - 1.0) <= kQuaternionTolerance)) {
    text << "the quaternion (w " << q.w() << ", x " << q.x() << ", y " << q.y() << ", z " << q.z() << ") has norm "
         << norm << " instead of 1: check the order of its numbers";
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
  const Rotation back = rotation.conjugate();
  return {-(back * translation), back};
}

}  // namespace gaussmap
