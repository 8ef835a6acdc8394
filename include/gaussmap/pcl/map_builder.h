// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <pcl/console/print.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <memory>

#include "gaussmap/core/scans.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/pcl/impl/sensor_pose.hpp"
#include "gaussmap/version.h"

namespace gaussmap {

/// Builds a map from several PCL clouds. It is used like pcl::octree::OctreePointCloud: for each cloud, call
/// setInputCloud() and addPointsFromInputCloud(). Call getMap() at the end, or at any time.
///
/// The class keeps exact moments per cell. The map is therefore the same for any order of the clouds and for any
/// division of the points into clouds, and adding them one by one takes no longer than adding them at once.
///
/// setIndices() selects points; as in PCL, the indices stay set for the following clouds. The pose of setSensorPose(),
/// or otherwise that in sensor_origin_ and sensor_orientation_, transforms the points into the map frame. If they are
/// already in the map frame, call setFrame(ScanFrame::Map). Non-finite points are ignored. With ScanFrame::Sensor,
/// points at the sensor are ignored too (see isReturn()). Any point type with x, y, z can be used. Errors are printed
/// and change nothing.
template <typename PointT>
class PointCloudMapBuilder : public detail::CloudInput<PointT> {
 public:
  using Ptr = pcl::shared_ptr<PointCloudMapBuilder>;             ///< shared pointer
  using ConstPtr = pcl::shared_ptr<const PointCloudMapBuilder>;  ///< shared pointer to const
  using MapConstPtr = std::shared_ptr<const GaussianMapOctree>;  ///< shared pointer to the map

  /// Makes an empty map. Throws std::invalid_argument if the options are not usable (see Grid).
  explicit PointCloudMapBuilder(const MapOptions& options = {})
      : grid_(options), moments_(grid_.options().resolution) {}

  /// Adds the points of the input cloud and returns the number of points added. Prints an error, adds nothing and
  /// returns 0 if there is no cloud, the pose has a fault, or a point lies beyond the range of 32-bit cell indices.
  std::size_t addPointsFromInputCloud() {
    if (!this->initCompute()) {
      PCL_ERROR("[gaussmap::PointCloudMapBuilder::addPointsFromInputCloud] no input cloud\n");
      return 0;
    }
    std::size_t added = 0;
    try {
      added = addSelectedPoints();
    } catch (const std::exception& error) {
      PCL_ERROR("[gaussmap::PointCloudMapBuilder::addPointsFromInputCloud] %s\n", error.what());
    }
    this->deinitCompute();
    if (added > 0) map_.reset();
    return added;
  }

  /// Returns the map of all points so far, with one Gaussian per cell at every scale. The first call after new points
  /// builds the map, so calls must not overlap. Pass the map to refine() to give coarse cells more Gaussians.
  MapConstPtr getMap() const {
    if (!map_) map_ = std::make_shared<const GaussianMapOctree>(build<3>(moments_, grid_.options()));
    return map_;
  }
  /// Returns the exact moments per cell, map frame.
  const MomentGrid<3>& moments() const { return moments_; }
  /// Removes all points.
  void deleteMap() {
    moments_ = MomentGrid<3>(grid_.options().resolution);
    map_.reset();
  }
  /// Returns the options, with the automatic noise filled in.
  const MapOptions& options() const { return grid_.options(); }

 private:
  /// Throws std::out_of_range if the index of the cell of a selected point does not fit 32 bits. This check comes
  /// first, so that a cloud is added as a whole or not at all.
  void checkRange(const Pose& pose) const {
    const double limit = 1e9 * moments_.resolution();  // below this, every index fits
    float largest = 0.0f;
    for (const PointT& point : *this->input_)
      for (const float coordinate : {point.x, point.y, point.z})
        if (std::isfinite(coordinate)) largest = std::max(largest, std::abs(coordinate));
    if (2.0 * double(largest) + pose.translation.norm() < limit) return;
    for (const auto index : *this->indices_) {
      const Eigen::Vector3d point =
          (*this->input_)[static_cast<std::size_t>(index)].getVector3fMap().template cast<double>();
      if (point.allFinite()) grid_.keyOf(pose * point);
    }
  }

  /// Adds the selected points, block by block, and returns their number.
  std::size_t addSelectedPoints() {
    const bool is_sensor_frame = this->frame() == ScanFrame::Sensor;
    const Pose pose = is_sensor_frame ? this->inputPose() : Pose();
    const bool moves = !pose.translation.isZero(0.0) || !(pose.rotation.vec().isZero(0.0));
    checkRange(pose);
    std::size_t added = 0;
    PointBlock<3> block;
    const auto addBlock = [&] {
      if (moves) transform(pose, block);
      added += moments_.add(block);
      block.size = 0;
    };
    for (const auto index : *this->indices_) {
      const PointT& point = (*this->input_)[static_cast<std::size_t>(index)];
      if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z)) continue;
      if (is_sensor_frame && point.x == 0.0f && point.y == 0.0f && point.z == 0.0f) continue;  // see isReturn()
      block.coordinate[0][block.size] = double(point.x);
      block.coordinate[1][block.size] = double(point.y);
      block.coordinate[2][block.size] = double(point.z);
      if (++block.size == block.kCapacity) addBlock();
    }
    if (block.size > 0) addBlock();
    return added;
  }

  Grid<3> grid_;
  MomentGrid<3> moments_;
  mutable MapConstPtr map_;  // null: not yet built with the last points
};

}  // namespace gaussmap
