// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/memory.h>
#include <pcl/pcl_macros.h>
#include <pcl/point_cloud.h>
#include <pcl/register_point_struct.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "gaussmap/core/gaussian.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
/// A point type of a user, registered as PCL requires it.
struct EIGEN_ALIGN16 RingPoint {
  PCL_ADD_POINT4D;
  float echo;
  std::uint16_t ring;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
#pragma GCC diagnostic pop
POINT_CLOUD_REGISTER_POINT_STRUCT(RingPoint,
                                  (float, x, x)(float, y, y)(float, z, z)(float, echo, echo)(std::uint16_t, ring, ring))

namespace gaussmap::test {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Returns a wavy floor of 4 m x 3 m, row by row.
template <typename PointT>
typename pcl::PointCloud<PointT>::Ptr wavyFloor(std::uint32_t width = 40, std::uint32_t height = 30) {
  auto cloud = pcl::make_shared<pcl::PointCloud<PointT>>(width, height);
  Random random(1);
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    const float x = 0.1f * static_cast<float>(i % width) + 0.02f * static_cast<float>(random.uniform());
    const float y = 0.1f * static_cast<float>(i / width) + 0.02f * static_cast<float>(random.uniform());
    (*cloud)[i].getVector3fMap() << x, y, 0.2f * std::sin(3.0f * x);
  }
  cloud->header.frame_id = "floor";
  cloud->header.stamp = 77;
  cloud->sensor_origin_ << 2.0f, 1.5f, 5.0f, 0.0f;
  return cloud;
}

template <typename PointT>
void makeNan(PointT& point) {
  point.x = point.y = point.z = kNan;
}

}  // namespace gaussmap::test
