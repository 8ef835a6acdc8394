// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <pcl/PointIndices.h>
#include <pcl/console/print.h>
#include <pcl/pcl_base.h>
#include <pcl/impl/pcl_base.hpp>  // a user's own point type has no other

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_fitter.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// SegmentFitter for PCL's clouds, one a sweep: setInputCloud(), setIndices() if only some points count, fit(); the
/// next cloud, fit() ... and map(). Points in the SENSOR frame, its pose in sensor_origin_ and sensor_orientation_, as
/// PCL's readers fill them. Any point type with x, y, z.
template <typename PointT>
class GAUSSMAP_API PointCloudSegmentFitter : public pcl::PCLBase<PointT> {
 public:
  /// Throws std::invalid_argument, naming the option.
  explicit PointCloudSegmentFitter(const SegmentFitterOptions& options = {},
                                   std::shared_ptr<SegmentUtility> utility = {})
      : fitter_(options, std::move(utility)) {}

  /// What of a cloud counts: a horizontal slice of a three-dimensional one, a largest range.
  void setPlanarScan(const PlanarScanOptions& options) { planar_ = options; }

  /// Adds the cloud to the map. A cloud that cannot be taken (none, in no plane, a pose that is none) changes nothing:
  /// an error is printed, and the statistics are those of no beam; an empty one does so in silence.
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

  /// The points of the input cloud on each segment of the map, as it is now, in its order: of each point the nearest
  /// segment, if it lies within `tolerance` [m] (and in the slice, if there is one); map frame, seen from above. A
  /// cloud that fit() would not take gives an error and nothing.
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

  SegmentMap map() const { return fitter_.map(); }
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
