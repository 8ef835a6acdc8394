// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <pcl/PointIndices.h>
#include <pcl/console/print.h>
#include <pcl/pcl_base.h>
#include <pcl/impl/pcl_base.hpp>  // required for user-defined point types

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_fitter.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Builds a map of segments from PCL clouds with SegmentFitter. Each cloud is one sweep of a planar laser.
///
/// For each cloud, call setInputCloud() and fit(); setIndices() before fit() selects points. At the end, call map().
/// The points are in the sensor frame, and the pose of the sensor is in sensor_origin_ and sensor_orientation_, as
/// after PCL's readers. Any point type with x, y, z can be used.
template <typename PointT>
class GAUSSMAP_API PointCloudSegmentFitter : public pcl::PCLBase<PointT> {
 public:
  /// Makes an empty map. The parameters are those of SegmentFitter. Throws std::invalid_argument if an option is out of
  /// range; the message names the option.
  explicit PointCloudSegmentFitter(const SegmentFitterOptions& options = {},
                                   std::shared_ptr<SegmentUtility> utility = {},
                                   std::shared_ptr<const ObservationModel> observation_model = {})
      : fitter_(options, std::move(utility), std::move(observation_model)) {}

  /// Sets which points of a cloud are used: a horizontal slice of a three-dimensional cloud, and a maximum range.
  void setPlanarScan(const PlanarScanOptions& options) { planar_ = options; }

  /// Adds the cloud to the map. If the cloud is not usable (no cloud, not in a plane, or an invalid pose), the function
  /// prints an error. It then changes nothing and returns statistics without beams. For an empty cloud it also changes
  /// nothing, but prints no error.
  SegmentStatistics fit() {
    if (!this->initCompute()) {
      PCL_ERROR("[gaussmap::PointCloudSegmentFitter::fit] no input cloud\n");
      return {};
    }
    Scan scan;
    const auto& cloud = *this->input_;
    scan.pose = sensorPose();
    for (const auto index : *this->indices_)
      scan.points.push_back(cloud[static_cast<std::size_t>(index)].getVector3fMap().template cast<double>());
    this->deinitCompute();
    if (scan.points.empty()) return {};
    try {
      if (const std::string fault = poseFault(scan.pose); !fault.empty()) throw std::invalid_argument(fault);
      scan.pose = normalised(scan.pose);
      return fitter_.add(planarScan(scan, planar_));
    } catch (const std::invalid_argument& error) {
      PCL_ERROR("[gaussmap::PointCloudSegmentFitter::fit] %s\n", error.what());
      return {};
    }
  }

  /// Moves the observer to a position [m, map frame] without a cloud, see SegmentFitter::observe(). Throws
  /// std::invalid_argument if the position is not finite.
  SegmentStatistics observe(const Vector<2>& position) { return fitter_.observe(position); }

  /// Finds the points of the input cloud that lie on each segment of the current map. `segments` gets one list of
  /// indices per segment, in the order of SegmentMap::segments.
  ///
  /// A point belongs to the nearest segment, if the distance in the xy plane of the map frame is at most `tolerance`
  /// [m]. If setPlanarScan() selected a slice, the point must also lie in the slice. Without a cloud or with an invalid
  /// pose, the function prints an error and `segments` is empty.
  void segmentIndices(std::vector<pcl::PointIndices>& segments, double tolerance = 0.1) {
    segments.clear();
    if (!this->initCompute()) {
      PCL_ERROR("[gaussmap::PointCloudSegmentFitter::segmentIndices] no input cloud\n");
      return;
    }
    Pose pose = sensorPose();
    if (const std::string fault = poseFault(pose); !fault.empty()) {
      PCL_ERROR("[gaussmap::PointCloudSegmentFitter::segmentIndices] %s\n", fault.c_str());
      this->deinitCompute();
      return;
    }
    pose = normalised(pose);
    const SegmentMap map = this->map();
    segments.resize(map.segments.size());
    for (pcl::PointIndices& segment : segments) segment.header = this->input_->header;
    for (const auto index : *this->indices_) {
      const Eigen::Vector3d sensed =
          (*this->input_)[static_cast<std::size_t>(index)].getVector3fMap().template cast<double>();
      const Eigen::Vector3d point = pose * sensed;
      if (!point.allFinite() || (planar_.slice && (point.z() < planar_.z_min || point.z() > planar_.z_max))) continue;
      double least = tolerance;
      pcl::PointIndices* nearest = nullptr;
      for (std::size_t s = 0; s < segments.size(); ++s) {
        const double distance = map.segments[s].distance({point.x(), point.y()});
        if (distance > least || (nearest && distance == least)) continue;
        least = distance;
        nearest = &segments[s];
      }
      if (nearest) nearest->indices.push_back(index);
    }
    this->deinitCompute();
  }

  /// Returns a copy of the current map.
  SegmentMap map() const { return fitter_.map(); }
  /// Returns the fitter.
  const SegmentFitter& fitter() const { return fitter_; }

 private:
  Pose sensorPose() const {
    Pose pose;
    pose.translation = this->input_->sensor_origin_.template head<3>().template cast<double>();
    pose.rotation = this->input_->sensor_orientation_.template cast<double>();
    return pose;
  }

  SegmentFitter fitter_;
  PlanarScanOptions planar_;
};

}  // namespace gaussmap
