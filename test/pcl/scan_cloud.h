// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>

#include "simulation/simulation.h"

namespace gaussmap {

/// The scan as PCL has it: floats in the sensor's frame, with its pose. Not dense, for tests put NaN in.
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
