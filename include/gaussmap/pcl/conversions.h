// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/range_image/range_image.h>
#include "gaussmap/core/pose.h"
#include "gaussmap/sensor/range_image.h"

#include <optional>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/pcl/point_gaussian.h"
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
