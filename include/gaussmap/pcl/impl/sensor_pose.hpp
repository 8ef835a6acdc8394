// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/console/print.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <pcl/impl/pcl_base.hpp>  // required for user-defined point types

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <exception>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "gaussmap/core/pose.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/version.h"

namespace gaussmap {

GAUSSMAP_API Pose poseOfMatrix(const Eigen::Matrix4d& matrix);  // see gaussmap/pcl/registration.h

namespace detail {

/// Returns the pose in a cloud's sensor_origin_ and sensor_orientation_, with a quaternion of unit length. Throws
/// std::invalid_argument if the pose has a fault (see poseFault()).
template <typename PointT>
Pose sensorPose(const pcl::PointCloud<PointT>& cloud) {
  Pose pose;
  pose.translation = cloud.sensor_origin_.template head<3>().template cast<double>();
  pose.rotation = cloud.sensor_orientation_.template cast<double>();
  if (const std::string fault = poseFault(pose); !fault.empty()) throw std::invalid_argument(fault);
  return normalised(pose);
}

/// Base of classes that take one cloud after the other: holds the input cloud, its indices and the pose of the sensor.
template <typename PointT>
class CloudInput : public pcl::PCLBase<PointT> {
 public:
  /// Sets the pose of the sensor for the following clouds: sensor frame to map frame. It is used instead of
  /// sensor_origin_ and sensor_orientation_, which are only floats.
  void setSensorPose(const Pose& pose) { pose_ = pose; }
  /// Sets the pose of the sensor as a rigid 4 x 4 transform. If the matrix is not a rigid transform, prints an error.
  /// Until a new pose is set, calls that need the pose then fail with an error.
  template <typename Scalar>
  void setSensorPose(const Eigen::Matrix<Scalar, 4, 4>& matrix) {
    try {
      pose_ = poseOfMatrix(matrix.template cast<double>());
    } catch (const std::invalid_argument&) {
      PCL_ERROR("[gaussmap::setSensorPose] the matrix is not a rigid transform\n");
      pose_.emplace();
      pose_->translation.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
  }
  /// Sets the pose of the sensor as an Eigen transform, for example Eigen::Isometry3d. It must be rigid.
  template <typename Scalar, int Mode>
  void setSensorPose(const Eigen::Transform<Scalar, 3, Mode>& transform) {
    setSensorPose(Eigen::Matrix<Scalar, 4, 4>(transform.matrix()));
  }
  /// Uses the pose in sensor_origin_ and sensor_orientation_ of each cloud. This is the default.
  void useSensorPoseOfCloud() { pose_.reset(); }
  /// Returns the pose of setSensorPose(), or std::nullopt if the pose of each cloud is used.
  const std::optional<Pose>& sensorPose() const { return pose_; }
  /// Sets the frame of the points. ScanFrame::Sensor (default): the pose transforms them into the map frame.
  /// ScanFrame::Map: the points are already in the map frame. PointCloudMapBuilder then ignores the pose, and
  /// PointCloudOnlineMapper uses it as the place from which the points were seen.
  void setFrame(ScanFrame frame) { frame_ = frame; }
  /// Returns the frame of the points.
  ScanFrame frame() const { return frame_; }

 protected:
  /// Returns the pose of the input cloud, with a quaternion of unit length. Throws std::invalid_argument if the pose
  /// has a fault.
  Pose inputPose() const {
    if (!pose_) return detail::sensorPose(*this->input_);
    if (const std::string fault = poseFault(*pose_); !fault.empty()) throw std::invalid_argument(fault);
    return normalised(*pose_);
  }
  /// Returns true if all points of the input are selected, in their order.
  bool isWholeInput() const {
    if (this->indices_->size() != this->input_->size()) return false;
    for (std::size_t i = 0; i < this->indices_->size(); ++i)
      if (static_cast<std::size_t>((*this->indices_)[i]) != i) return false;
    return true;
  }

 private:
  std::optional<Pose> pose_;
  ScanFrame frame_ = ScanFrame::Sensor;
};

}  // namespace detail
}  // namespace gaussmap
