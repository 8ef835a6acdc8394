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

void transform(const Pose& pose, PointBlock<3>& block) {
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const Eigen::Vector3d& t = pose.translation;
  double* x = block.coordinate[0];
  double* y = block.coordinate[1];
  double* z = block.coordinate[2];
  for (std::size_t i = 0; i < block.size; ++i) {
    const double px = x[i], py = y[i], pz = z[i];
    x[i] = rotation(0, 0) * px + rotation(0, 1) * py + rotation(0, 2) * pz + t.x();
    y[i] = rotation(1, 0) * px + rotation(1, 1) * py + rotation(1, 2) * pz + t.y();
    z[i] = rotation(2, 0) * px + rotation(2, 1) * py + rotation(2, 2) * pz + t.z();
  }
}

}  // namespace gaussmap
