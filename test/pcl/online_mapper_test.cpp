// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/online_mapper.h"

#include <gtest/gtest.h>
#include <pcl/point_types.h>

#include <cmath>
#include <limits>

#include "gaussmap/pcl/conversions.h"
#include "io/gmap/map_equality.h"
#include "pcl/random_surface.h"
#include "pcl/scan_cloud.h"

namespace gaussmap {
namespace {

using test::expectSameMap;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// Scans of a street with traffic, coarse enough for a test.
std::vector<SimulatedScan> streetScans() {
  Simulation street = makeSimulation(WorldName::Street, {5, true});
  auto& lidar = std::get<LidarOptions>(street.sensor);
  lidar.rings = 16;
  lidar.columns = 450;
  std::vector<SimulatedScan> scans;
  for (std::size_t i = 0; i < street.trajectory.size(); ++i) scans.push_back(simulateScan(street, i));
  return scans;
}

/// An organised cloud of a depth camera that looks at a wall 3 m away, with some pixels without depth.
Cloud::Ptr frameOfCamera(float wall = 3.0f) {
  auto cloud = pcl::make_shared<Cloud>(80, 60);
  for (std::uint32_t row = 0; row < 60; ++row)
    for (std::uint32_t column = 0; column < 80; ++column) {
      pcl::PointXYZ& point = cloud->at(int(column), int(row));
      point.z = wall + 0.01f * static_cast<float>((row * 7 + column * 3) % 5);
      point.x = point.z * (static_cast<float>(column) - 39.5f) / 70.0f;
      point.y = point.z * (static_cast<float>(row) - 29.5f) / 70.0f;
      if ((row + column) % 11 == 0) test::makeNan(point);
    }
  cloud->is_dense = false;
  return cloud;
}

OnlineOptions coarse() {
  OnlineOptions options;
  options.map = {0.2, 5, 3, 0.0};
  options.refine_every = 2;
  return options;
}

template <typename PointT>
class PointCloudOnlineMapperOf : public testing::Test {};
using PointTypes = testing::Types<pcl::PointXYZ, pcl::PointXYZI, RingPoint>;
TYPED_TEST_SUITE(PointCloudOnlineMapperOf, PointTypes, );

TYPED_TEST(PointCloudOnlineMapperOf, GivesTheMapOfTheCore) {
  OnlineMapper<3> core(coarse());
  PointCloudOnlineMapper<TypeParam> mapper(coarse());
  for (const SimulatedScan& scan : streetScans()) {
    const auto cloud = cloudOf<TypeParam>(scan);
    const OnlineStatistics expected = core.add(toScan(*cloud));
    mapper.setInputCloud(cloud);
    ASSERT_TRUE(mapper.update());
    EXPECT_EQ(mapper.getStatistics().points.accepted, expected.points.accepted);
    EXPECT_EQ(mapper.getStatistics().deleted, expected.deleted);
    EXPECT_EQ(mapper.getStatistics().added, expected.added);
  }
  EXPECT_EQ(mapper.scans(), core.scans());
  EXPECT_TRUE(mapper.getMap()->hasOccupancy());
  expectSameMap<3>(*mapper.getMap(), core.map());
}

TEST(PointCloudOnlineMapper, TakesAGivenPoseAndPointsInTheMapFrame) {
  PointCloudOnlineMapper<pcl::PointXYZ> by_cloud(coarse()), by_pose(coarse()), in_map(coarse());
  in_map.setFrame(ScanFrame::Map);
  for (const SimulatedScan& scan : streetScans()) {
    auto cloud = cloudOf<pcl::PointXYZ>(scan);
    by_cloud.setInputCloud(cloud);
    EXPECT_TRUE(by_cloud.update());
    const Pose pose = toScan(*cloud).pose;
    auto moved = pcl::make_shared<Cloud>(*cloud);
    for (auto& point : *moved)
      point.getVector3fMap() = (pose * Eigen::Vector3d(point.getVector3fMap().cast<double>())).cast<float>();
    in_map.setInputCloud(moved);
    EXPECT_TRUE(in_map.update());
    cloud = pcl::make_shared<Cloud>(*cloud);
    cloud->sensor_origin_.setConstant(7.0f);
    by_pose.setInputCloud(cloud);
    by_pose.setSensorPose(pose);
    EXPECT_TRUE(by_pose.update());
  }
  expectSameMap<3>(*by_pose.getMap(), *by_cloud.getMap());
  // Floats in the map frame: points at the borders of cells can fall into the next cell.
  EXPECT_NEAR(in_map.getMap()->weight(0), by_cloud.getMap()->weight(0), 20.0);
  EXPECT_NEAR(double(in_map.getMap()->cellCount(0)), double(by_cloud.getMap()->cellCount(0)), 20.0);
}

TEST(PointCloudOnlineMapper, KeepsTheRowsAndColumnsOfADepthCamera) {
  OnlineMapper<3> core(coarse());
  PointCloudOnlineMapper<pcl::PointXYZ> mapper(coarse());
  for (const float wall : {2.0f, 3.0f, 3.0f, 3.0f, 3.0f}) {  // something stood before the wall and has gone
    const auto frame = frameOfCamera(wall);
    Scan scan = toScan(*frame);
    ASSERT_EQ(scan.columns, 80);
    core.add(scan);
    mapper.setInputCloud(frame);
    ASSERT_TRUE(mapper.update());
  }
  expectSameMap<3>(*mapper.getMap(), core.map());
  for (std::size_t i = 0; i < mapper.getMap()->gaussianCount(0); ++i)
    EXPECT_GT(mapper.getMap()->gaussian(i, 0).mean.z(),
              2.5);  // the rays through the pixels have shown that it has gone
}

TEST(PointCloudOnlineMapper, TakesPointsThatAreNotSelectedAsNoReturn) {
  const auto frame = frameOfCamera();
  const auto left = pcl::make_shared<pcl::Indices>();
  Scan expected = toScan(*frame);
  for (std::size_t i = 0; i < frame->size(); ++i) {
    if (i % 80 < 40)
      left->push_back(int(i));
    else
      expected.points[i].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  OnlineMapper<3> core(coarse());
  core.add(expected);
  PointCloudOnlineMapper<pcl::PointXYZ> mapper(coarse());
  mapper.setInputCloud(frame);
  mapper.setIndices(left);
  ASSERT_TRUE(mapper.update());
  expectSameMap<3>(*mapper.getMap(), core.map());
}

TEST(PointCloudOnlineMapper, TellsOfDeletedClustersAndRestoresThem) {
  std::vector<RemovedCluster<3>> removed;
  PointCloudOnlineMapper<pcl::PointXYZ> mapper(coarse(),
                                               [&](const RemovedCluster<3>& cluster) { removed.push_back(cluster); });
  RemovedCluster<3> nothing;
  EXPECT_FALSE(mapper.restore(nothing));  // no map
  for (const float wall : {2.0f, 3.0f, 3.0f, 3.0f, 3.0f}) {
    mapper.setInputCloud(frameOfCamera(wall));
    mapper.update();
  }
  ASSERT_FALSE(removed.empty());
  const double weight = mapper.getMap()->weight(0);
  const RemovedCluster<3>& finest =
      *std::find_if(removed.begin(), removed.end(), [](const auto& cluster) { return cluster.scale == 0; });
  EXPECT_TRUE(mapper.restore(finest));
  EXPECT_EQ(mapper.getMap()->weight(0), weight + finest.gaussian.weight);
  nothing.scale = 1;
  EXPECT_FALSE(mapper.restore(nothing));
}

TEST(PointCloudOnlineMapper, ChangesNothingAfterAnError) {
  PointCloudOnlineMapper<pcl::PointXYZ> mapper(coarse());
  EXPECT_FALSE(mapper.update());  // no cloud
  EXPECT_TRUE(mapper.getMap()->empty());
  mapper.setInputCloud(frameOfCamera());
  EXPECT_TRUE(mapper.update());
  const auto map = mapper.getMap();
  auto faulty = frameOfCamera();
  faulty->sensor_orientation_ = Eigen::Quaternionf(0, 0, 0, 0);
  mapper.setInputCloud(faulty);
  EXPECT_FALSE(mapper.update());
  EXPECT_EQ(mapper.getStatistics().points.read, 0);
  auto far = frameOfCamera();
  (*far)[1].x = 1e12f;
  mapper.setInputCloud(far);
  EXPECT_FALSE(mapper.update());
  EXPECT_EQ(mapper.scans(), 1u);
  expectSameMap<3>(*mapper.getMap(), *map);
  mapper.reset();
  mapper.setResolution(-1.0);
  mapper.setInputCloud(frameOfCamera());
  EXPECT_FALSE(mapper.update());  // the option has a fault
  mapper.setResolution(0.5);
  EXPECT_TRUE(mapper.update());
  EXPECT_EQ(mapper.getMap()->options().resolution, 0.5);
}

TEST(PointCloudOnlineMapper, CountsAnEmptyCloudAsAScan) {
  PointCloudOnlineMapper<pcl::PointXYZ> mapper(coarse());
  mapper.setInputCloud(pcl::make_shared<Cloud>());
  EXPECT_TRUE(mapper.update());
  EXPECT_EQ(mapper.scans(), 1u);
  EXPECT_TRUE(mapper.getMap()->empty());
}

}  // namespace
}  // namespace gaussmap
