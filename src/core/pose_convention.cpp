// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/scans.h"

namespace gaussmap {
namespace {

/// Returns the motion that turns lidar axes (x forward, y left, z up) into those of a camera (x right, y down,
/// z forward).
Pose lidarToCamera() {
  return {Eigen::Vector3d::Zero(), Pose::Rotation(0.5, 0.5, -0.5, 0.5)};
}

}  // namespace

Pose poseAs(PoseConvention convention, const Pose& read) {
  const Pose::Rotation& q = read.rotation;
  switch (convention) {
    case PoseConvention::SensorToMap:
      return read;
    case PoseConvention::NoMotion:
      return {};
    case PoseConvention::Inverse:
      return read.inverse();
    case PoseConvention::WFirst:
      return {read.translation, Pose::Rotation(q.x(), q.y(), q.z(), q.w())};
    case PoseConvention::WLast:
      return {read.translation, Pose::Rotation(q.z(), q.w(), q.x(), q.y())};
    case PoseConvention::Camera:
      return lidarToCamera().inverse() * read * lidarToCamera();
    case PoseConvention::Optical:
      return lidarToCamera() * read * lidarToCamera().inverse();
  }
  return read;
}

}  // namespace gaussmap
