// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include "gaussmap/version.h"

namespace gaussmap {

/// Where a sensor stood: p_map = R p_sensor + t.
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

}  // namespace gaussmap
