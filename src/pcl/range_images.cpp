// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/conversions.h"

#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace gaussmap {
namespace {

Eigen::Affine3f affineOf(const Pose& pose) {
  Eigen::Affine3f affine = Eigen::Affine3f::Identity();
  affine.linear() = pose.rotation.toRotationMatrix().cast<float>();
  affine.translation() = pose.translation.cast<float>();
  return affine;
}

}  // namespace

pcl::RangeImage toPclRangeImage(const RangeImage& image, const Pose& sensor) {
  const auto* const projection = std::get_if<SphericalProjection>(&image.projection());
  if (!projection)
    throw std::invalid_argument(
        "the range image of a camera cannot become a pcl::RangeImage, which has pixels of equal angles");
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (int row = 0; row < image.rows(); ++row)
    for (int column = 0; column < image.columns(); ++column) {
      if (image.at(row, column).empty()) continue;
      const Eigen::Vector3d point = sensor.rotation * image.nearestPoint(row, column) + sensor.translation;
      cloud.emplace_back(float(point.x()), float(point.y()), float(point.z()));
    }
  pcl::RangeImage result;
  if (cloud.empty()) return result;
  const auto width = static_cast<float>(2.0 * M_PI / projection->columns);
  const auto height =
      static_cast<float>((projection->row_borders.back() - projection->row_borders.front()) / image.rows());
  result.createFromPointCloud(cloud, width, height, float(2.0 * M_PI), float(M_PI), affineOf(sensor),
                              pcl::RangeImage::LASER_FRAME, 0.0f, 0.0f, 0);
  return result;
}

RangeImage fromPclRangeImage(const pcl::RangeImage& image, const Pose& sensor) {
  const double width = image.getAngularResolutionX(), height = image.getAngularResolutionY();
  if (image.points.empty() || !(width > 0.0) || !(height > 0.0))
    throw std::invalid_argument("the pcl::RangeImage is empty or has no angular resolution, number of pixels: " +
                                std::to_string(image.points.size()));
  SphericalProjection projection;
  projection.columns = std::max(1, static_cast<int>(std::lround(2.0 * M_PI / width)));
  const int rows = std::max(1, static_cast<int>(std::lround(M_PI / height)));
  for (int row = 0; row <= rows; ++row) projection.row_borders.push_back(M_PI * row / rows - 0.5 * M_PI);
  RangeImage result((Projection(projection)));
  const Eigen::Matrix3d to_sensor = sensor.rotation.toRotationMatrix().transpose();
  for (const pcl::PointWithRange& pixel : image.points)
    if (std::isfinite(pixel.range) && pixel.range > 0.0f)
      result.add(to_sensor * (pixel.getVector3fMap().cast<double>() - sensor.translation));
  return result;
}

}  // namespace gaussmap
