// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "gaussmap/version.h"

namespace gaussmap {

/// A rigid motion. As the pose of a sensor: p_map = R p_sensor + t. As the motion of a map into another frame:
/// p_target = R p_source + t.
struct GAUSSMAP_API Pose {
  /// Type of the quaternion. It is stored unaligned, so that its layout does not depend on the -m flags of the compiler
  /// (see kStorage in gaussian.h).
  using Rotation = Eigen::Quaternion<double, Eigen::DontAlign>;

  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< t, the sensor's origin [m], map frame
  Rotation rotation = Rotation::Identity();               ///< R as a quaternion, sensor frame to map frame

  /// Transforms a point from the sensor frame to the map frame [m]. As for all members of this class, the quaternion
  /// must have unit length.
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + translation; }
  /// Returns the composition of two poses: `other` is applied first, then this pose.
  Pose operator*(const Pose& other) const;
  /// Returns the inverse, from the map frame to the sensor frame.
  Pose inverse() const;
};

/// Maximum difference between the norm of a quaternion and 1. It allows for quaternions that a text file gives with few
/// decimals. A larger difference means that the numbers are wrong, for example columns in the wrong order.
inline constexpr double kQuaternionTolerance = 1e-3;

/// Checks a pose, for example one read from a file. Returns a text that describes its fault, or an empty text if it has
/// none.
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
