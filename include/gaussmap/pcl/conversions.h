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

/// The Gaussians of all scales (coarsest first) or of one, in key order. Means are relative to sensor_origin_, which is
/// zero but for maps so far away that floats would lose a thousandth of a finest cell.
/// Throws std::out_of_range for a scale that the map does not have.
GAUSSMAP_API pcl::PointCloud<PointGaussian> toPointCloud(const GaussianMapOctree& map,
                                                         std::optional<int> scale = std::nullopt);

/// The map such a cloud describes, see fromRecords(). Throws std::invalid_argument, saying what, if it describes none.
GAUSSMAP_API GaussianMapOctree fromPointCloud(const pcl::PointCloud<PointGaussian>& cloud);

/// The map of a cloud in the map frame, made on `threads` threads (0 = all), which never show in it; non-finite points
/// are left out. Any point type with x, y, z.
/// Throws std::invalid_argument on unusable options, std::out_of_range for a point too far for the cells.
template <typename PointT>
GaussianMapOctree buildMap(const pcl::PointCloud<PointT>& cloud, const MapOptions& options = {}, int threads = 0) {
  static_assert(sizeof(PointT) % sizeof(float) == 0);
  const PointsView points{cloud.empty() ? nullptr : cloud[0].data, cloud.size(), sizeof(PointT) / sizeof(float)};
  return build<3>(countPoints(Grid<3>(options).options().resolution, points, threads), options);
}

/// The nearest ranges as PCL's range image (pixels of equal angles, LASER_FRAME: x forward, y left, z up), with the
/// sensor at `sensor` in the map frame. Of an image without any return: an empty one. Throws std::invalid_argument for
/// a camera's image: PCL has another class for those.
GAUSSMAP_API pcl::RangeImage toPclRangeImage(const RangeImage& image, const Pose& sensor);

/// The other way round: rows and columns are those of PCL's image; its far ranges (+infinity) and what it has not
/// observed become pixels without a return. `sensor` is the pose that PCL's image was made with.
/// Throws std::invalid_argument if the image has no angular resolution (it is empty).
GAUSSMAP_API RangeImage fromPclRangeImage(const pcl::RangeImage& image, const Pose& sensor);

}  // namespace gaussmap
