// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/range_image/range_image.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/pcl/impl/sensor_pose.hpp"
#include "gaussmap/pcl/point_gaussian.h"
#include "gaussmap/sensor/range_image.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Converts the Gaussians of all scales (coarsest first), or of one scale, to a PCL cloud in key order.
///
/// The means are relative to the cloud's sensor_origin_. This is zero unless the map is so far from the origin that a
/// float would be wrong by more than 1/1000 of the side of a finest cell. Throws std::out_of_range if the map does not
/// have the scale.
GAUSSMAP_API pcl::PointCloud<PointGaussian> toPointCloud(const GaussianMapOctree& map,
                                                         std::optional<int> scale = std::nullopt);

/// Converts a PCL cloud of Gaussians to a map, see fromRecords(). Throws std::invalid_argument if the cloud does not
/// form a map; the message gives the reason.
GAUSSMAP_API GaussianMapOctree fromPointCloud(const pcl::PointCloud<PointGaussian>& cloud);

/// Builds the map of a cloud in the map frame, for any point type with x, y, z. `threads`: 0 = all cores.
///
/// Non-finite points are ignored. Throws std::invalid_argument if an option is not usable, and std::out_of_range if a
/// point lies beyond the range of 32-bit cell indices.
template <typename PointT>
GaussianMapOctree buildMap(const pcl::PointCloud<PointT>& cloud, const MapOptions& options = {}, int threads = 0) {
  static_assert(sizeof(PointT) % sizeof(float) == 0);
  const PointsView points{cloud.empty() ? nullptr : cloud[0].data, cloud.size(), sizeof(PointT) / sizeof(float)};
  return build<3>(countPoints(Grid<3>(options).options().resolution, points, threads), options);
}

/// Converts a PCL cloud to a scan. The points must be in the sensor frame [m]; any point type with x, y, z can be used.
///
/// Coordinates are converted from float to double without loss. The pose is that in sensor_origin_ and
/// sensor_orientation_, with the quaternion scaled to unit length. NaN points stay, and an organised cloud keeps its
/// number of columns. Scan::time [s] comes from header.stamp [us]; a stamp of 0 means that the time is unknown. Throws
/// std::invalid_argument if the pose has a fault (see poseFault()).
template <typename PointT>
Scan toScan(const pcl::PointCloud<PointT>& cloud) {
  Scan scan;
  scan.pose = detail::sensorPose(cloud);
  scan.columns = cloud.height > 1 ? static_cast<int>(cloud.width) : 0;
  if (cloud.header.stamp > 0) scan.time = 1e-6 * static_cast<double>(cloud.header.stamp);
  scan.points.reserve(cloud.size());
  for (const PointT& point : cloud) scan.points.push_back(point.getVector3fMap().template cast<double>());
  return scan;
}

/// Converts a scan to a PCL cloud of any point type with x, y, z, for example `toPointCloud<pcl::PointXYZ>(scan)`. The
/// points stay in the sensor frame [m]. All other fields have the values of a new point.
///
/// NaN points stay, and an organised scan stays organised. is_dense is true if all points are finite. header.stamp is
/// the time, rounded to microseconds; it is 0 if the time is unknown or negative. The points and the pose of the sensor
/// are rounded to floats. For points within 100 m of the sensor, the error is below 4 um. The error of the position of
/// the sensor grows with its distance from the origin of the map: 1 mm at 16 km, 3 cm at 500 km. Far from the origin,
/// pass Scan::pose to the setSensorPose() of PointCloudMapBuilder or PointCloudOnlineMapper. Throws
/// std::invalid_argument if the number of points is not a multiple of Scan::columns.
template <typename PointT>
pcl::PointCloud<PointT> toPointCloud(const Scan& scan) {
  const auto columns = static_cast<std::size_t>(scan.columns > 0 ? scan.columns : 0);
  if (columns > 0 && scan.points.size() % columns != 0)
    throw std::invalid_argument("the scan has " + std::to_string(scan.points.size()) +
                                " points, which is not a multiple of its " + std::to_string(columns) + " columns");
  pcl::PointCloud<PointT> cloud;
  cloud.resize(scan.points.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud[i].getVector3fMap() = scan.points[i].cast<float>();
    cloud.is_dense = cloud.is_dense && cloud[i].getVector3fMap().allFinite();
  }
  if (columns > 0) {
    cloud.width = static_cast<std::uint32_t>(columns);
    cloud.height = static_cast<std::uint32_t>(scan.points.size() / columns);
  }
  cloud.sensor_origin_.template head<3>() = scan.pose.translation.cast<float>();
  cloud.sensor_orientation_ = Eigen::Quaterniond(scan.pose.rotation).cast<float>();
  if (scan.time && *scan.time > 0.0) cloud.header.stamp = static_cast<std::uint64_t>(std::llround(1e6 * *scan.time));
  return cloud;
}

/// Converts a range image to PCL's range image. A pixel gets its nearest range. `sensor` is the pose of the sensor:
/// sensor frame to map frame.
///
/// PCL's image has pixels of equal angles and the frame LASER_FRAME: x forward, y left, z up. An image without returns
/// becomes an empty image. Throws std::invalid_argument for the image of a camera, because PCL has another class for
/// it.
GAUSSMAP_API pcl::RangeImage toPclRangeImage(const RangeImage& image, const Pose& sensor);

/// Converts PCL's range image to a range image with the same angular resolution.
///
/// Far ranges (+infinity) and unobserved pixels become pixels without a return. `sensor` is the pose of the sensor with
/// which PCL's image was made. Throws std::invalid_argument if the image is empty or has no angular resolution.
GAUSSMAP_API RangeImage fromPclRangeImage(const pcl::RangeImage& image, const Pose& sensor);

}  // namespace gaussmap
