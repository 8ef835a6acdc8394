// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <pcl/console/print.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "gaussmap/core/scans.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "gaussmap/pcl/impl/sensor_pose.hpp"
#include "gaussmap/version.h"

namespace gaussmap {

/// Builds a map scan by scan from PCL clouds with OnlineMapper, which forgets objects that have moved away.
///
/// For each cloud, call setInputCloud() and update(). getMap() returns the map at any time. The pose of the sensor is
/// that of setSensorPose(), or otherwise that in sensor_origin_ and sensor_orientation_ of each cloud. The points are
/// in the sensor frame, unless setFrame(ScanFrame::Map) was called. In an organised cloud, for example of a depth
/// camera, each point is a pixel. NaN points and points that setIndices() does not select are pixels without a return.
/// Any point type with x, y, z can be used. Errors are printed and change nothing.
template <typename PointT>
class PointCloudOnlineMapper : public detail::CloudInput<PointT> {
 public:
  using Ptr = pcl::shared_ptr<PointCloudOnlineMapper>;             ///< shared pointer
  using ConstPtr = pcl::shared_ptr<const PointCloudOnlineMapper>;  ///< shared pointer to const
  using MapConstPtr = std::shared_ptr<const GaussianMapOctree>;    ///< shared pointer to the map
  using Removed = OnlineMapper<3>::Removed;                        ///< function that receives a deleted cluster

  /// Stores the options. They are checked by the first update(). `removed` is called for every deleted cluster.
  explicit PointCloudOnlineMapper(const OnlineOptions& options = {}, Removed removed = {})
      : options_(options), removed_(std::move(removed)) {}

  /// Sets the side of the finest cells [m]. Like all options, it has no effect on a map that was already begun: set it
  /// before the first update(), or call reset().
  void setResolution(double side) { options_.map.resolution = side; }
  /// Sets all options, with effect as for setResolution().
  void setOptions(const OnlineOptions& options) { options_ = options; }
  /// Returns the options.
  const OnlineOptions& options() const { return options_; }

  /// Adds the input cloud to the map and returns true. Prints an error and returns false if there is no cloud, an
  /// option or the pose has a fault, or a point lies beyond the range of 32-bit cell indices. The map is then
  /// unchanged. A cloud without points counts as a scan in which no beam returned.
  bool update() {
    statistics_ = {};
    if (!this->initCompute()) {
      PCL_ERROR("[gaussmap::PointCloudOnlineMapper::update] no input cloud\n");
      return false;
    }
    bool added = false;
    try {
      Scan scan = scanOfInput();
      if (!mapper_) mapper_.emplace(options_, removed_);
      statistics_ = mapper_->add(std::move(scan));
      map_.reset();
      added = true;
    } catch (const std::exception& error) {
      PCL_ERROR("[gaussmap::PointCloudOnlineMapper::update] %s\n", error.what());
    }
    this->deinitCompute();
    return added;
  }

  /// Returns a copy of the current map. Only the first call after an update() makes the copy, so calls must not
  /// overlap.
  MapConstPtr getMap() const {
    if (!map_) map_ = std::make_shared<const GaussianMapOctree>(mapper_ ? mapper_->map() : GaussianMapOctree());
    return map_;
  }
  /// Returns the statistics of the last update(). After an error, all counts are 0.
  const OnlineStatistics& getStatistics() const { return statistics_; }
  /// Returns the number of scans in the map.
  std::size_t scans() const { return mapper_ ? mapper_->scans() : 0; }
  /// Puts a deleted cluster of the finest scale back, see OnlineMapper::restore(). Prints an error and returns false if
  /// there is no map or the cluster is of another scale.
  bool restore(const RemovedCluster<3>& removed) {
    if (!mapper_ || removed.scale != 0) {
      PCL_ERROR("[gaussmap::PointCloudOnlineMapper::restore] %s\n", mapper_ ? "not a finest cluster" : "no map");
      return false;
    }
    mapper_->restore(removed);
    map_.reset();
    return true;
  }
  /// Deletes the map. The next update() begins a new one.
  void reset() {
    mapper_.reset();
    map_.reset();
    statistics_ = {};
  }

 private:
  /// Returns the input as a scan in the sensor frame. Throws std::invalid_argument if the pose has a fault.
  Scan scanOfInput() const {
    const auto& cloud = *this->input_;
    Scan scan;
    scan.pose = this->inputPose();
    if (cloud.header.stamp > 0) scan.time = 1e-6 * static_cast<double>(cloud.header.stamp);
    const Eigen::Matrix3d to_sensor = scan.pose.rotation.toRotationMatrix().transpose();
    const auto pointAt = [&](std::size_t i) -> Eigen::Vector3d {
      const Eigen::Vector3d point = cloud[i].getVector3fMap().template cast<double>();
      return this->frame() == ScanFrame::Map ? Eigen::Vector3d(to_sensor * (point - scan.pose.translation)) : point;
    };
    if (cloud.height > 1) {
      scan.columns = static_cast<int>(cloud.width);
      scan.points.assign(cloud.size(), Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
      for (const auto index : *this->indices_)
        scan.points[static_cast<std::size_t>(index)] = pointAt(static_cast<std::size_t>(index));
    } else {
      scan.points.reserve(this->indices_->size());
      for (const auto index : *this->indices_) scan.points.push_back(pointAt(static_cast<std::size_t>(index)));
    }
    return scan;
  }

  OnlineOptions options_;
  Removed removed_;
  std::optional<OnlineMapper<3>> mapper_;  // made by the first update()
  OnlineStatistics statistics_;
  mutable MapConstPtr map_;  // null: not copied since the last update
};

}  // namespace gaussmap
