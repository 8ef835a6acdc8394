// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>

#include "simulation/simulation.h"

namespace gaussmap {

/// Returns the scan as a PCL cloud: floats in the frame of the sensor, with its pose. is_dense is false because tests
/// add NaN.
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr cloudOf(const SimulatedScan& scan) {
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>();
  for (const Eigen::Vector3d& point : scan.points) {
    PointT made{};
    made.getVector3fMap() = point.cast<float>();
    cloud->push_back(made);
  }
  cloud->is_dense = false;
  cloud->sensor_origin_.template head<3>() = scan.pose.translation.template cast<float>();
  cloud->sensor_orientation_ = Eigen::Quaterniond(scan.pose.rotation).cast<float>();
  return cloud;
}

}  // namespace gaussmap
