// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/conversions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "gaussmap/sensor/visibility.h"
#include "simulation/lidar.h"

namespace gaussmap {
namespace {

/// Eigen allocates otherwise under the address sanitizer: memory of PCL's library, which is built without, cannot be
/// freed here then.
#ifdef __SANITIZE_ADDRESS__
constexpr bool kMixedAllocators = true;
#else
constexpr bool kMixedAllocators = false;
#endif

constexpr double kDegree = 3.14159265358979323846 / 180.0;

Pose somePose() {
  Pose pose;
  pose.translation = {3.0, -2.0, 1.5};
  pose.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ());
  return pose;
}

/// A wall 10 m in front of a sensor that looks along x, one degree a pixel.
RangeImage wallImage() {
  SphericalProjection projection;
  for (int row = 0; row <= 40; ++row) projection.row_borders.push_back((row - 20) * kDegree);
  projection.columns = 360;
  RangeImage image((Projection(projection)));
  for (int row = 0; row < 40; ++row)
    for (int column = 160; column < 200; ++column) {
      const Eigen::Vector3d ray = directionOf(image.projection(), {row, column});
      image.add(10.0 / ray.x() * ray);
    }
  return image;
}

TEST(RangeImages, ReachPclWithTheirRangesAndPlaces) {
  if (kMixedAllocators) GTEST_SKIP() << "PCL's library is built without the sanitizer";
  const Pose pose = somePose();
  const pcl::RangeImage pcl_image = toPclRangeImage(wallImage(), pose);
  std::size_t seen = 0;
  for (const pcl::PointWithRange& pixel : pcl_image.points) {
    if (!std::isfinite(pixel.range)) continue;
    ++seen;
    const Eigen::Vector3d point =
        pose.rotation.conjugate() * (pixel.getVector3fMap().cast<double>() - pose.translation);
    EXPECT_NEAR(point.x(), 10.0, 0.1);  // PCL moves points into the middle of its pixels
    EXPECT_NEAR(point.norm(), double(pixel.range), 1e-3);
  }
  EXPECT_GT(seen, 1200u);  // of 1600: where pixel borders differ, two may fall into one
}

TEST(RangeImages, ComeBackFromPclAndSeeTheSame) {
  if (kMixedAllocators) GTEST_SKIP() << "PCL's library is built without the sanitizer";
  const Pose pose = somePose();
  const RangeImage there = wallImage(), back = fromPclRangeImage(toPclRangeImage(there, pose), pose);
  EXPECT_NEAR(double(back.farthest()), double(there.farthest()), 1e-3);
  for (const double x : {3.0, 6.0, 9.0, 9.9, 10.1, 12.0}) {
    const Eigen::Vector3d point(x, 0.03, 0.02);
    EXPECT_EQ(visibilityOf(back, point), visibilityOf(there, point)) << x;
  }
}

TEST(RangeImages, WithoutReturnsAreEmptyInPcl) {
  SphericalProjection projection{{-0.1, 0.0, 0.1}, 360};
  EXPECT_TRUE(toPclRangeImage(RangeImage(Projection(projection)), Pose()).points.empty());
  EXPECT_THROW(fromPclRangeImage(pcl::RangeImage(), Pose()), std::invalid_argument);
}

TEST(RangeImages, OfACameraAreRefused) {
  EXPECT_THROW(toPclRangeImage(RangeImage(Projection(PlanarProjection{100.0, 100.0, 50.0, 50.0, 100, 100})), Pose()),
               std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
