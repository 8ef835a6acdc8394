// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <pcl/common/transforms.h>

#include <cmath>
#include <sstream>

#include "gaussmap/pcl/point_gaussian.h"

namespace gaussmap {
namespace {

using Cloud = pcl::PointCloud<PointGaussian>;

PointGaussian longAlongX(float x) {
  PointGaussian point{};
  point.x = x;
  point.data[3] = 1.0f;
  point.covariance[0] = 4.0f;   // xx
  point.covariance[1] = 0.5f;   // xy
  point.covariance[3] = 1.0f;   // yy
  point.covariance[5] = 0.25f;  // zz
  point.weight = 7.0f;
  point.cell_x = 3;
  return point;
}

Cloud twoGaussians() {
  Cloud cloud;
  cloud.push_back(longAlongX(1.0f));
  cloud.push_back(longAlongX(2.0f));
  cloud.header.frame_id = "map";
  return cloud;
}

/// A quarter turn about z, then 10 m along x: (x, y, z) becomes (10 - y, x, z).
const Eigen::Affine3f kTurn(Eigen::Translation3f(10.0f, 0.0f, 0.0f) *
                            Eigen::Quaternionf(std::sqrt(0.5f), 0, 0, std::sqrt(0.5f)));

void expectTurned(const PointGaussian& point, float x) {
  EXPECT_NEAR(point.x, 10.0f, 1e-5f);
  EXPECT_NEAR(point.y, x, 1e-5f);
  EXPECT_NEAR(point.z, 0.0f, 1e-5f);
  const float expected[6] = {1.0f, -0.5f, 0.0f, 4.0f, 0.0f, 0.25f};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(point.covariance[i], expected[i], 1e-5f) << i;
  EXPECT_EQ(point.data[3], 1.0f);
}

template <typename... Arguments>
void expectTurnedByAll(const Arguments&... arguments) {
  const Cloud in = twoGaussians();
  Cloud by_pcl, by_type, same = in;
  pcl::transformPointCloud(in, by_pcl, arguments...);
  transformPointCloud(in, by_type, arguments...);
  pcl::transformPointCloud(same, same, arguments...);
  for (const Cloud* out : {&by_pcl, &by_type, &same}) {
    ASSERT_EQ(out->size(), 2u);
    expectTurned((*out)[0], 1.0f);
    expectTurned((*out)[1], 2.0f);
    EXPECT_EQ((*out)[1].weight, 7.0f);
    EXPECT_EQ((*out)[1].cell_x, 3);
    EXPECT_EQ(out->header.frame_id, "map");
  }
}

TEST(TransformPointCloud, RotatesCovariancesForEveryFormOfATransform) {
  const Eigen::Affine3d turn = kTurn.cast<double>();
  const Eigen::Matrix4f back = kTurn.inverse().matrix();
  expectTurnedByAll(kTurn);
  expectTurnedByAll(turn);
  expectTurnedByAll(Eigen::Matrix4f(kTurn.matrix()));
  expectTurnedByAll(Eigen::Matrix4d(turn.matrix()));
  expectTurnedByAll(back.inverse());  // an expression, not a matrix
  expectTurnedByAll(Eigen::Vector3f(kTurn.translation()), Eigen::Quaternionf(kTurn.rotation()));
  expectTurnedByAll(Eigen::Vector3d(turn.translation()), Eigen::Quaterniond(turn.rotation()));
}

TEST(TransformPointCloud, TakesIndices) {
  pcl::PointIndices second;
  second.indices = {1};
  const Eigen::Affine3d turn = kTurn.cast<double>();
  const auto expect = [&](const auto& transform) {
    Cloud out;
    pcl::transformPointCloud(twoGaussians(), second.indices, out, transform);
    ASSERT_EQ(out.size(), 1u);
    expectTurned(out[0], 2.0f);
    pcl::transformPointCloud(twoGaussians(), second, out, transform);
    ASSERT_EQ(out.size(), 1u);
    expectTurned(out[0], 2.0f);
  };
  expect(kTurn);
  expect(turn);
  expect(Eigen::Matrix4f(kTurn.matrix()));
  expect(Eigen::Matrix4d(turn.matrix()));
}

TEST(TransformPointCloud, StretchesCovariancesWithTheirCloud) {
  Eigen::Matrix4d stretch = Eigen::Matrix4d::Identity();
  stretch(0, 0) = 3.0;
  Cloud out;
  pcl::transformPointCloud(twoGaussians(), out, stretch);
  EXPECT_FLOAT_EQ(out[1].x, 6.0f);
  EXPECT_FLOAT_EQ(out[1].covariance[0], 36.0f);
  EXPECT_FLOAT_EQ(out[1].covariance[1], 1.5f);
}

TEST(TransformPointCloud, CopiesOtherFieldsOnlyIfAsked) {
  Cloud out;
  pcl::transformPointCloud(twoGaussians(), out, kTurn, false);
  expectTurned(out[1], 2.0f);
  EXPECT_EQ(out[1].weight, 0.0f);
}

TEST(TransformPointCloud, OfPclItselfLeavesCovariancesAsTheyAre) {
  Cloud out;
  pcl::transformPointCloud<PointGaussian, float>(twoGaussians(), out, kTurn.matrix());  // PCL's template by name
  EXPECT_NEAR(out[0].y, 1.0f, 1e-5f);
  EXPECT_EQ(out[0].covariance[0], 4.0f);
}

TEST(PointGaussian, WritesItsFieldsInOneLine) {
  std::ostringstream text;
  text << longAlongX(1.5f);
  EXPECT_EQ(text.str(), "(1.5,0,0 - covariance 4,0.5,0,1,0,0.25 - weight 7, occupancy 0, cell 3,0,0 of 0 m, scale 0)");
}

}  // namespace
}  // namespace gaussmap
