// SPDX-License-Identifier: BSD-3-Clause
// A user's own point type: PCL's rule for all of its classes is this line before its headers.
#define PCL_NO_PRECOMPILE
#include <gtest/gtest.h>

#include "gaussmap/pcl/normal_estimation.h"
#include "pcl/random_surface.h"

namespace gaussmap {
namespace {

TEST(CellNormalEstimation, TakesAUsersOwnPointType) {
  const auto cloud = test::wavyFloor<RingPoint>();
  const auto plain = test::wavyFloor<pcl::PointXYZ>();
  CellNormalEstimation<RingPoint> own;
  CellNormalEstimation<pcl::PointXYZ> usual;
  own.setInputCloud(cloud);
  usual.setInputCloud(plain);
  pcl::PointCloud<pcl::Normal> normals, expected;
  own.compute(normals);
  usual.compute(expected);
  ASSERT_EQ(normals.size(), expected.size());
  EXPECT_EQ(normals.height, cloud->height);
  for (std::size_t i = 0; i < normals.size(); ++i)
    EXPECT_EQ(normals[i].getNormalVector3fMap(), expected[i].getNormalVector3fMap());
}

}  // namespace
}  // namespace gaussmap
