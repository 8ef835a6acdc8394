// SPDX-License-Identifier: BSD-3-Clause
// A user's own point type: PCL's rule for all of its classes is this line before its headers.
#define PCL_NO_PRECOMPILE
#include <gtest/gtest.h>
#include <pcl/memory.h>
#include <pcl/pcl_macros.h>
#include <pcl/register_point_struct.h>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/pcl/registration.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
struct EIGEN_ALIGN16 ReturnPoint {
  PCL_ADD_POINT4D;
  float echo;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};
#pragma GCC diagnostic pop
POINT_CLOUD_REGISTER_POINT_STRUCT(ReturnPoint, (float, x, x)(float, y, y)(float, z, z)(float, echo, echo))

namespace gaussmap {
namespace {

/// A floor and two walls, moved by `by` along x.
pcl::PointCloud<ReturnPoint>::Ptr corner(float by, std::uint64_t seed) {
  Random random(seed);
  auto cloud = pcl::make_shared<pcl::PointCloud<ReturnPoint>>();
  for (int i = 0; i < 9000; ++i) {
    ReturnPoint point{};
    point.getVector3fMap() = 6.0 * Eigen::Vector3d(random.uniform(), random.uniform(), random.uniform()).cast<float>();
    point.getVector3fMap()[i % 3] = 0.1f;
    point.x += by;
    point.echo = static_cast<float>(i);
    cloud->push_back(point);
  }
  return cloud;
}

TEST(GaussianMapRegistration, TakesAUsersOwnPointType) {
  GaussianMapRegistration<ReturnPoint, ReturnPoint> ours;
  ours.setInputTarget(corner(0.0f, 1));
  ours.setInputSource(corner(-0.3f, 2));
  pcl::PointCloud<ReturnPoint> output;
  ours.align(output);
  EXPECT_TRUE(ours.hasConverged());
  EXPECT_NEAR(ours.getFinalTransformation()(0, 3), 0.3, 0.02);
  EXPECT_LT(ours.getFitnessScore(), 0.05);
  EXPECT_EQ(output[17].echo, 17.0f);
}

}  // namespace
}  // namespace gaussmap
