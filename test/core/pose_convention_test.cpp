// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/scans.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace gaussmap {
namespace {

const double kHalf = std::sqrt(0.5);

/// A pose that turns x to y and moves by (1, 2, 3).
Pose quarterTurn() {
  return {{1.0, 2.0, 3.0}, Pose::Rotation(kHalf, 0.0, 0.0, kHalf)};
}

TEST(PoseConvention, ConvertsTheInverseAndPointsInTheMapFrame) {
  EXPECT_TRUE(
      (poseAs(PoseConvention::Inverse, quarterTurn()) * Eigen::Vector3d(1, 3, 3)).isApprox(Eigen::Vector3d(1, 0, 0)));
  EXPECT_TRUE(
      (poseAs(PoseConvention::NoMotion, quarterTurn()) * Eigen::Vector3d(4, 5, 6)).isApprox(Eigen::Vector3d(4, 5, 6)));
}

TEST(PoseConvention, ReordersQuaternions) {
  // The words 0.1 0.5 0.7 0.5, read as x y z w although w is first.
  const Pose read{{1, 2, 3}, Pose::Rotation(0.5, 0.1, 0.5, 0.7)};
  const Pose w_first = poseAs(PoseConvention::WFirst, read);
  EXPECT_EQ(w_first.translation, read.translation);
  EXPECT_EQ(w_first.rotation.w(), 0.1);
  EXPECT_EQ(w_first.rotation.x(), 0.5);
  EXPECT_EQ(w_first.rotation.y(), 0.7);
  EXPECT_EQ(w_first.rotation.z(), 0.5);
  EXPECT_EQ(poseAs(PoseConvention::WLast, w_first).rotation.coeffs(), read.rotation.coeffs());
}

TEST(PoseConvention, ConvertsCameraPosesToLidarAxes) {
  // The camera moves 4 m along its z axis (forward) and turns right, about its y axis (down).
  const Pose camera{{0, 0, 4}, Pose::Rotation(kHalf, 0.0, kHalf, 0.0)};
  const Pose lidar = poseAs(PoseConvention::Camera, camera);
  EXPECT_TRUE(lidar.translation.isApprox(Eigen::Vector3d(4, 0, 0)));
  EXPECT_TRUE((lidar.rotation * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0, -1, 0)));
  const Pose back = poseAs(PoseConvention::Optical, lidar);
  EXPECT_TRUE(back.translation.isApprox(camera.translation));
  EXPECT_NEAR(std::abs(back.rotation.dot(camera.rotation)), 1.0, 1e-12);
}

}  // namespace
}  // namespace gaussmap
