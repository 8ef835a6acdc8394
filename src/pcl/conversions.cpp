// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/conversions.h"

#include <algorithm>

#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap {

pcl::PointCloud<PointGaussian> toPointCloud(const GaussianMapOctree& map, std::optional<int> scale) {
  const GaussianRecords all = toRecords(map, scale);
  pcl::PointCloud<PointGaussian> cloud;
  cloud.reserve(all.records.size());
  cloud.sensor_origin_.head<3>() = all.origin.cast<float>();
  for (const GaussianRecord& record : all.records) {
    PointGaussian point;
    for (int axis = 0; axis < 3; ++axis)
      point.getVector3fMap()(axis) = static_cast<float>(record.mean[static_cast<std::size_t>(axis)]);
    point.data[3] = 1.0f;
    std::copy(record.covariance.begin(), record.covariance.end(), point.covariance);
    point.weight = record.weight;
    point.occupancy = record.occupancy;
    point.cell_side = record.cell_side;
    point.scale = record.scale;
    point.cell_x = record.cell[0];
    point.cell_y = record.cell[1];
    point.cell_z = record.cell[2];
    cloud.push_back(point);
  }
  return cloud;
}

GaussianMapOctree fromPointCloud(const pcl::PointCloud<PointGaussian>& cloud) {
  GaussianRecords all{{}, cloud.sensor_origin_.head<3>().cast<double>()};
  all.records.reserve(cloud.size());
  for (const PointGaussian& point : cloud) {
    GaussianRecord record{{double{point.x}, double{point.y}, double{point.z}},
                          {},
                          point.weight,
                          point.occupancy,
                          point.cell_side,
                          point.scale,
                          {point.cell_x, point.cell_y, point.cell_z}};
    std::copy(std::begin(point.covariance), std::end(point.covariance), record.covariance.begin());
    all.records.push_back(record);
  }
  return fromRecords(all);
}

}  // namespace gaussmap
