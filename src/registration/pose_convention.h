// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "gaussmap/core/pose.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// What poses of a file can mean, other than what this library expects.
enum class PoseConvention {
  SensorToMap,  ///< as expected: the pose moves points from the sensor frame into the map frame
  NoMotion,     ///< the points are already in the map frame
  Inverse,      ///< the pose moves points from the map frame into the sensor frame
  WFirst,       ///< the quaternion was read as x y z w, but is written as w x y z
  WLast,        ///< the quaternion was read as w x y z, but is written as x y z w
  Camera,       ///< the pose is that of a camera (x right, y down, z forward) on a lidar (x forward, y left, z up)
  Optical       ///< the pose is that of a body (x forward, y left, z up), but the points have the axes of a camera
};
inline constexpr std::array<PoseConvention, 7> kPoseConventions = {
    PoseConvention::SensorToMap, PoseConvention::NoMotion, PoseConvention::Inverse, PoseConvention::WFirst,
    PoseConvention::WLast,       PoseConvention::Camera,   PoseConvention::Optical};

/// Returns the pose, from the sensor frame to the map frame, of a scan whose pose was read as `read`.
///
/// Camera and Optical change the axes on both sides, as for the poses of KITTI odometry: the map has the axes of the
/// points. The distance between camera and lidar is unknown and counts as zero.
GAUSSMAP_API Pose poseAs(PoseConvention convention, const Pose& read);

}  // namespace gaussmap::detail
