// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

#include "gaussmap/version.h"

namespace gaussmap {

/// A rigid motion: where a sensor stood, or how a map is moved. p_map = R p_sensor + t, or p_target = R p + t.
struct GAUSSMAP_API Pose {
  /// Unaligned, for the reason given in gaussian.h.
  using Rotation = Eigen::Quaternion<double, Eigen::DontAlign>;

  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< t, the sensor's origin [m], map frame
  Rotation rotation = Rotation::Identity();               ///< R as a quaternion, sensor frame to map frame

  /// A point of the sensor frame, in the map frame. The quaternion must have unit length, as for all operators.
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rotation * point + translation; }
  /// First `other`, then this pose.
  Pose operator*(const Pose& other) const;
  /// Map frame to sensor frame.
  Pose inverse() const;
};

/// How far the norm of a quaternion may be from 1: text files round to few digits, more than this is another number.
inline constexpr double kQuaternionTolerance = 1e-3;

/// What is wrong with a pose as it came from a file, empty if nothing is: a translation or quaternion that is not
/// finite, a quaternion that is zero or further than kQuaternionTolerance from unit length.
GAUSSMAP_API std::string poseFault(const Pose& pose);

/// The same pose with a quaternion of unit length. The quaternion must not be zero.
GAUSSMAP_API Pose normalised(const Pose& pose);

/// Covariance of a pose, 6 x 6: of the translation x y z [m], then of a small rotation about x y z [rad]. All axes are
/// those of the target (map) frame; the rotation is about the origin of what is moved (the sensor).
using PoseCovariance = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;

/// The covariance of pose.inverse(), if `covariance` is that of `pose`. The quaternion must have unit length.
GAUSSMAP_API PoseCovariance covarianceOfInverse(const Pose& pose, const PoseCovariance& covariance);

}  // namespace gaussmap
