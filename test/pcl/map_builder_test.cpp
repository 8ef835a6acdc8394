// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/map_builder.h"

#include <gtest/gtest.h>
#include <pcl/point_types.h>

#include <cmath>
#include <memory>

#include "gaussmap/pcl/conversions.h"
#include "io/gmap/map_equality.h"
#include "pcl/random_surface.h"
#include "pcl/scan_cloud.h"

namespace gaussmap {
namespace {

using test::expectSameMap;
using test::makeNan;
using test::wavyFloor;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

const MapOptions kOptions{0.2, 5, 3, 0.0};

/// A wavy floor in three clouds, none of them with a sensor pose.
std::vector<Cloud::Ptr> threeClouds() {
  const auto floor = wavyFloor<pcl::PointXYZ>();
  std::vector<Cloud::Ptr> clouds;
  for (std::size_t part = 0; part < 3; ++part) {
    clouds.push_back(pcl::make_shared<Cloud>());
    for (std::size_t i = part; i < floor->size(); i += 3) clouds.back()->push_back((*floor)[i]);
  }
  return clouds;
}

template <typename PointT>
class PointCloudMapBuilderOf : public testing::Test {};
using PointTypes = testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointNormal, RingPoint>;
TYPED_TEST_SUITE(PointCloudMapBuilderOf, PointTypes, );

TYPED_TEST(PointCloudMapBuilderOf, GivesTheMapOfTheCloudBitByBit) {
  auto cloud = wavyFloor<TypeParam>();
  makeNan((*cloud)[5]);
  PointCloudMapBuilder<TypeParam> builder(kOptions);
  builder.setFrame(ScanFrame::Map);
  builder.setInputCloud(cloud);
  EXPECT_EQ(builder.addPointsFromInputCloud(), cloud->size() - 1);
  expectSameMap<3>(*builder.getMap(), buildMap(*cloud, kOptions));
}

TEST(PointCloudMapBuilder, GivesTheMapOfAllCloudsInAnyOrder) {
  const std::vector<Cloud::Ptr> clouds = threeClouds();
  Cloud all;
  for (const auto& cloud : clouds) all += *cloud;
  const GaussianMapOctree expected = buildMap(all, kOptions);
  for (const auto& order : {std::vector<std::size_t>{0, 1, 2}, {2, 0, 1}}) {
    PointCloudMapBuilder<pcl::PointXYZ> builder(kOptions);
    for (const std::size_t i : order) {
      builder.setInputCloud(clouds[i]);
      EXPECT_EQ(builder.addPointsFromInputCloud(), clouds[i]->size());
      builder.getMap();  // asking in between changes nothing
    }
    expectSameMap<3>(*builder.getMap(), expected);
    EXPECT_EQ(builder.moments().pointCount(), std::int64_t(all.size()));
  }
}

TEST(PointCloudMapBuilder, MovesPointsByThePoseOfTheCloudLikeTheCore) {
  const Simulation corner = makeSimulation(WorldName::Corner, {4, false});
  PointCloudMapBuilder<pcl::PointXYZ> builder(kOptions), given(kOptions);
  MemoryScans scans;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto cloud = cloudOf<pcl::PointXYZ>(simulateScan(corner, i));
    scans.add(toScan(*cloud));
    builder.setInputCloud(cloud);
    builder.addPointsFromInputCloud();
    const Pose pose = toScan(*cloud).pose;
    auto without = pcl::make_shared<Cloud>(*cloud);
    without->sensor_origin_.setConstant(99.0f);
    given.setInputCloud(without);
    given.setSensorPose(pose);
    given.addPointsFromInputCloud();
  }
  const GaussianMapOctree expected = build(scans, kOptions);
  expectSameMap<3>(*builder.getMap(), expected);
  expectSameMap<3>(*given.getMap(), expected);
}

TEST(PointCloudMapBuilder, TakesThePoseInAnyFormOfEigen) {
  Eigen::Affine3d motion(Eigen::Translation3d(1.0, -2.0, 0.5) *
                         Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()));
  const auto cloud = threeClouds()[0];
  PointCloudMapBuilder<pcl::PointXYZ> builder(kOptions);
  builder.setInputCloud(cloud);
  const auto meanWith = [&](const auto& pose) {
    builder.deleteMap();
    builder.setSensorPose(pose);
    EXPECT_EQ(builder.addPointsFromInputCloud(), cloud->size());
    const GaussianMapOctree& map = *builder.getMap();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < map.gaussianCount(0); ++i) sum += map.gaussian(i, 0).weight * map.gaussian(i, 0).mean;
    return Eigen::Vector3d(sum / map.weight(0));
  };
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& point : *cloud) mean += point.getVector3fMap().cast<double>() / double(cloud->size());
  const Eigen::Vector3d expected = motion * mean;
  EXPECT_LT((meanWith(motion) - expected).norm(), 1e-4);
  EXPECT_LT((meanWith(Eigen::Affine3f(motion.cast<float>())) - expected).norm(), 1e-4);
  EXPECT_LT((meanWith(Eigen::Isometry3d(motion.matrix())) - expected).norm(), 1e-4);
  EXPECT_LT((meanWith(Eigen::Matrix4d(motion.matrix())) - expected).norm(), 1e-4);
  EXPECT_LT((meanWith(Eigen::Matrix4f(motion.matrix().cast<float>())) - expected).norm(), 1e-4);
  builder.useSensorPoseOfCloud();
  builder.deleteMap();
  builder.addPointsFromInputCloud();
  expectSameMap<3>(*builder.getMap(), buildMap(*cloud, kOptions));
}

TEST(PointCloudMapBuilder, AddsOnlyTheSelectedPoints) {
  const auto cloud = threeClouds()[0];
  Cloud some;
  const auto indices = pcl::make_shared<pcl::Indices>();
  for (int i = 0; i < int(cloud->size()); i += 4) {
    indices->push_back(i);
    some.push_back((*cloud)[std::size_t(i)]);
  }
  PointCloudMapBuilder<pcl::PointXYZ> builder(kOptions);
  builder.setInputCloud(cloud);
  builder.setIndices(indices);
  EXPECT_EQ(builder.addPointsFromInputCloud(), some.size());
  expectSameMap<3>(*builder.getMap(), buildMap(some, kOptions));
}

TEST(PointCloudMapBuilder, IgnoresPointsAtTheSensor) {
  auto cloud = pcl::make_shared<Cloud>();
  cloud->emplace_back(0.0f, 0.0f, 0.0f);  // some drivers write this for "no return"
  cloud->emplace_back(1.0f, 0.0f, 0.0f);
  PointCloudMapBuilder<pcl::PointXYZ> builder;
  builder.setInputCloud(cloud);
  EXPECT_EQ(builder.addPointsFromInputCloud(), 1u);
  builder.setFrame(ScanFrame::Map);  // there the origin is a place like any other
  EXPECT_EQ(builder.addPointsFromInputCloud(), 2u);
}

TEST(PointCloudMapBuilder, BuildsTheMapOnlyAfterNewPoints) {
  const std::vector<Cloud::Ptr> clouds = threeClouds();
  PointCloudMapBuilder<pcl::PointXYZ> builder(kOptions);
  EXPECT_TRUE(builder.getMap()->empty());
  builder.setInputCloud(clouds[0]);
  builder.addPointsFromInputCloud();
  const auto first = builder.getMap();
  EXPECT_EQ(builder.getMap(), first);
  builder.addPointsFromInputCloud();
  EXPECT_NE(builder.getMap(), first);
  EXPECT_EQ(builder.getMap()->weight(0), 2.0 * first->weight(0));
  builder.deleteMap();
  EXPECT_TRUE(builder.getMap()->empty());
  EXPECT_FALSE(first->empty());  // the user's copy lives on
}

TEST(PointCloudMapBuilder, AddsNothingAfterAnError) {
  PointCloudMapBuilder<pcl::PointXYZ> builder(kOptions);
  EXPECT_EQ(builder.addPointsFromInputCloud(), 0u);  // no cloud
  auto cloud = threeClouds()[0];
  cloud->sensor_orientation_ = Eigen::Quaternionf(0, 0, 0, 0);
  builder.setInputCloud(cloud);
  EXPECT_EQ(builder.addPointsFromInputCloud(), 0u);
  builder.setSensorPose(Eigen::Matrix4f(2.0f * Eigen::Matrix4f::Identity()));  // not rigid
  EXPECT_EQ(builder.addPointsFromInputCloud(), 0u);
  builder.setSensorPose(Pose());
  cloud->emplace_back(1e12f, 0.0f, 0.0f);  // beyond the cells: the points before it are not added either
  EXPECT_EQ(builder.addPointsFromInputCloud(), 0u);
  EXPECT_TRUE(builder.getMap()->empty());
  EXPECT_THROW(PointCloudMapBuilder<pcl::PointXYZ>(MapOptions{-1.0, 10, 3, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
