// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "gaussmap/version.h"

namespace gaussmap {

/// A rigid motion: the pose of a sensor, p_map = R p_sensor + t, or the motion of a map, p_target = R p + t.
struct GAUSSMAP_API Pose {
  /// Type of the quaternion. It is stored unaligned, for the reason given at kStorage in gaussian.h.
  using Rotation = Eigen::Quaternion<double, Eigen::DontAlign>;

  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< t, the sensor's origin [m], map frame
  Rotation rotation = Rotation::Identity();               ///< R as a quaternion, sensor frame to map frame

  /// Returns a point of the sensor frame in the map frame [m]. The quaternion must have unit length, as for all
  /// operators.
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + translation; }
  /// Returns the composition of two poses: `other` is applied first, then this pose.
  Pose operator*(const Pose& other) const;
  /// Returns the inverse, from the map frame to the sensor frame.
  Pose inverse() const;
};

/// Maximum difference between the norm of a quaternion and 1. Text files round quaternions to few digits; a larger
/// difference means that the numbers are not a quaternion.
inline constexpr double kQuaternionTolerance = 1e-3;

/// Returns the fault of a pose from a file, or an empty text if there is none.
///
/// A pose has a fault if its translation or quaternion is not finite, if its quaternion is zero, or if the norm of the
/// quaternion differs from 1 by more than kQuaternionTolerance.
GAUSSMAP_API std::string poseFault(const Pose& pose);

/// Returns the pose with its quaternion scaled to unit length. The quaternion must not be zero.
GAUSSMAP_API Pose normalised(const Pose& pose);

/// The covariance of a pose, 6 x 6: of the translation x y z [m], then of a small rotation about x y z [rad].
///
/// The axes are those of the target (map) frame. The rotation is about the origin of the moved (sensor) frame.
using PoseCovariance = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;
/// A direction in the space of poses, 6 x 1: translation, then rotation, as in PoseCovariance.
using PoseDirection = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;

/// Returns the covariance of pose.inverse(), given the covariance of `pose`. The quaternion must have unit length.
GAUSSMAP_API PoseCovariance covarianceOfInverse(const Pose& pose, const PoseCovariance& covariance);

}  // namespace gaussmap
