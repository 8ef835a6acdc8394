// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/normal_estimation.h"

#include <gtest/gtest.h>
#include <pcl/features/normal_3d.h>
#include <pcl/features/impl/normal_3d.hpp>

#include <algorithm>
#include <cmath>

#include "pcl/random_surface.h"

namespace gaussmap {
namespace {

using test::makeNan;
using test::wavyFloor;

template <typename PointT>
class NormalEstimationTwin : public testing::Test {};
using PointTypes =
    testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointNormal, pcl::PointXYZINormal>;
TYPED_TEST_SUITE(NormalEstimationTwin, PointTypes, );

/// Both on the same calls.
template <typename PointT, typename SetUp>
std::pair<pcl::PointCloud<pcl::Normal>, pcl::PointCloud<pcl::Normal>> both(const SetUp& set_up) {
  pcl::NormalEstimation<PointT, pcl::Normal> twin;
  CellNormalEstimation<PointT> ours;
  std::pair<pcl::PointCloud<pcl::Normal>, pcl::PointCloud<pcl::Normal>> result;
  twin.setKSearch(20);
  ours.setKSearch(20);
  set_up(twin);
  set_up(ours);
  twin.compute(result.first);
  ours.compute(result.second);
  EXPECT_EQ(result.first.size(), result.second.size());
  EXPECT_EQ(result.first.width, result.second.width);
  EXPECT_EQ(result.first.height, result.second.height);
  EXPECT_EQ(result.first.is_dense, result.second.is_dense);
  EXPECT_EQ(result.first.header.frame_id, result.second.header.frame_id);
  return result;
}

double medianDegrees(const pcl::PointCloud<pcl::Normal>& a, const pcl::PointCloud<pcl::Normal>& b) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    EXPECT_EQ(std::isfinite(a[i].normal_x), std::isfinite(b[i].normal_x)) << i;
    if (!std::isfinite(a[i].normal_x)) continue;
    const float cosine = a[i].getNormalVector3fMap().dot(b[i].getNormalVector3fMap());
    angles.push_back(57.2958 * std::acos(std::min(1.0, double(cosine))));  // signs count
  }
  std::nth_element(angles.begin(), angles.begin() + std::ptrdiff_t(angles.size() / 2), angles.end());
  return angles[angles.size() / 2];
}

TYPED_TEST(NormalEstimationTwin, GivesTheNormalsOfPclTowardsTheSensor) {
  const auto cloud = wavyFloor<TypeParam>(120, 90);
  const auto [theirs, ours] = both<TypeParam>([&](auto& each) { each.setInputCloud(cloud); });
  EXPECT_EQ(ours.height, 90u);
  EXPECT_LT(medianDegrees(theirs, ours), 5.0);
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const Eigen::Vector3f sight = cloud->sensor_origin_.template head<3>() - (*cloud)[i].getVector3fMap();
    EXPECT_GE(ours[i].getNormalVector3fMap().dot(sight), 0.0f);
  }
}

TYPED_TEST(NormalEstimationTwin, LeavesNanWherePclDoes) {
  auto cloud = wavyFloor<TypeParam>();
  for (const std::size_t i : {0u, 77u, 1199u}) makeNan((*cloud)[i]);
  cloud->is_dense = false;
  const auto [theirs, ours] = both<TypeParam>([&](auto& each) { each.setInputCloud(cloud); });
  EXPECT_LT(medianDegrees(theirs, ours), 5.0);
  EXPECT_FALSE(ours.is_dense);
  EXPECT_TRUE(std::isnan(ours[77].curvature));
}

TYPED_TEST(NormalEstimationTwin, TakesIndicesSurfaceAndViewpointAsPclDoes) {
  const auto cloud = wavyFloor<TypeParam>(120, 90);
  const auto some = pcl::make_shared<pcl::Indices>();
  for (int i = int(cloud->size()) - 1; i >= 0; i -= 5) some->push_back(i);
  const auto [theirs, ours] = both<TypeParam>([&](auto& each) {
    each.setInputCloud(cloud);
    each.setIndices(some);
    each.setViewPoint(0, 0, -100);
  });
  EXPECT_EQ(ours.size(), some->size());
  EXPECT_LT(medianDegrees(theirs, ours), 5.0);
  for (const pcl::Normal& normal : ours) EXPECT_LT(normal.normal_z, 0.0f);

  const auto few = wavyFloor<TypeParam>(10, 8);
  const auto [their_few, our_few] = both<TypeParam>([&](auto& each) {
    each.setInputCloud(few);
    each.setSearchSurface(cloud);
  });
  EXPECT_EQ(our_few.size(), 80u);
  EXPECT_LT(medianDegrees(their_few, our_few), 5.0);
}

TEST(CellNormalEstimation, TellsItsViewpointAsPclDoes) {
  const auto cloud = wavyFloor<pcl::PointXYZ>();
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> twin;
  CellNormalEstimation<pcl::PointXYZ> ours;
  const auto expectSame = [&] {
    Eigen::Vector3f a, b;
    twin.getViewPoint(a.x(), a.y(), a.z());
    ours.getViewPoint(b.x(), b.y(), b.z());
    EXPECT_EQ(a, b);
  };
  expectSame();
  const auto each = [&](const auto& call) {
    call(twin);
    call(ours);
    expectSame();
  };
  each([&](auto& e) { e.setInputCloud(cloud); });
  each([&](auto& e) { e.setViewPoint(1, 2, 3); });
  each([&](auto& e) { e.setInputCloud(cloud); });
  each([&](auto& e) { e.useSensorOriginAsViewPoint(); });
}

TEST(CellNormalEstimation, WritesIntoPointsThatHaveNormals) {
  const auto cloud = wavyFloor<pcl::PointXYZ>();
  CellNormalEstimation<pcl::PointXYZ, pcl::PointNormal> ours;
  ours.setInputCloud(cloud);
  pcl::PointCloud<pcl::PointNormal> output;
  ours.compute(output);
  ASSERT_EQ(output.size(), cloud->size());
  EXPECT_NEAR(output[600].getNormalVector3fMap().norm(), 1.0f, 1e-5f);
  EXPECT_EQ(output[600].x, 0.0f);
}

TEST(CellNormalEstimation, GivesNothingForNothingAndNanForTooLittle) {
  CellNormalEstimation<pcl::PointXYZ> ours;
  pcl::PointCloud<pcl::Normal> output(3, 1);
  ours.compute(output);
  EXPECT_TRUE(output.empty());
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  ours.setInputCloud(cloud);
  ours.compute(output);
  EXPECT_TRUE(output.empty());
  cloud->emplace_back(1.0f, 2.0f, 3.0f);
  ours.compute(output);
  ASSERT_EQ(output.size(), 1u);
  EXPECT_TRUE(std::isnan(output[0].normal_x));
  EXPECT_FALSE(output.is_dense);
  ours.setSearchSurface(pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>());
  ours.compute(output);
  ASSERT_EQ(output.size(), 1u);
  EXPECT_TRUE(std::isnan(output[0].normal_x));
  ours.setMinPoints(1);
  ours.compute(output);
  EXPECT_TRUE(output.empty());
}

}  // namespace
}  // namespace gaussmap
