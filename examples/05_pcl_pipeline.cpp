// SPDX-License-Identifier: BSD-3-Clause
// Uses gaussmap with PCL: thins out a cloud, builds its map, and aligns the cloud.   Usage: 05_pcl_pipeline CLOUD.pcd
#include <gaussmap/pcl/conversions.h>
#include <gaussmap/pcl/gaussian_map_filter.h>
#include <gaussmap/pcl/registration.h>
#include <pcl/common/transforms.h>
#include <pcl/io/pcd_io.h>

#include <cstdio>
#include <memory>

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

int main(int, char** argv) {
  const Cloud::Ptr cloud(new Cloud);
  if (pcl::io::loadPCDFile(argv[1], *cloud) != 0) return 1;
  cloud->sensor_origin_.setZero();  // use the cloud in its own frame
  cloud->sensor_orientation_.setIdentity();

  gaussmap::GaussianMapFilter<pcl::PointXYZ> filter;
  filter.setBudget(2000);
  filter.setInputCloud(cloud);
  const Cloud::Ptr few(new Cloud), moved(new Cloud);
  filter.filter(*few);

  gaussmap::MapOptions options;
  options.resolution = 0.5;
  const auto map = std::make_shared<const gaussmap::GaussianMapOctree>(gaussmap::buildMap(*cloud, options));
  pcl::transformPointCloud(*cloud, *moved, Eigen::Vector3f(0.2f, -0.1f, 0.0f), Eigen::Quaternionf::Identity());
  gaussmap::GaussianMapRegistration<pcl::PointXYZ, pcl::PointXYZ> registration;
  registration.setTargetMap(map);
  registration.setInputSource(moved);
  Cloud aligned;
  registration.align(aligned);
  const Eigen::Matrix4f found = registration.getFinalTransformation();
  std::printf("%zu of %zu points, moved back by %.2f %.2f\n", few->size(), cloud->size(), found(0, 3), found(1, 3));
  return registration.hasConverged() ? 0 : 1;
}
