// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/pcl/dynamic_points_filter.h"

#include <gtest/gtest.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/impl/passthrough.hpp>

#include <cmath>

#include "gaussmap/mapping/online/online_mapper.h"
#include "gaussmap/pcl/conversions.h"
#include "map/inherit_occupancy.h"
#include "mesh/shapes.h"
#include "pcl/random_surface.h"
#include "pcl/scan_cloud.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::makeNan;
using test::wavyFloor;

/// A map of the floor in which all with x < 2 m is free: what pcl::PassThrough on x >= 2 keeps.
std::shared_ptr<const GaussianMapOctree> halfFreeMap() {
  const GaussianMapOctree map = buildMap(*wavyFloor<pcl::PointXYZ>(), {0.5, 10, 2, 0.0});
  std::vector<float> log_odds;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i)
    log_odds.push_back(map.gaussian(i, 0).mean.x() < 2.0 ? -1.0f : 1.0f);
  return std::make_shared<GaussianMapOctree>(withOccupancy<3>(map, log_odds));
}

template <typename PointT>
void setUp(pcl::PassThrough<PointT>& twin) {
  twin.setFilterFieldName("x");
  twin.setFilterLimits(2.0f, 1e9f);
}

template <typename PointT>
bool isSame(const PointT& a, const PointT& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (a.data[axis] != b.data[axis] && !(std::isnan(a.data[axis]) && std::isnan(b.data[axis]))) return false;
  return true;
}

template <typename PointT>
class DynamicPointsFilterTwin : public testing::Test {};
using PointTypes =
    testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointNormal, pcl::PointXYZINormal, RingPoint>;
TYPED_TEST_SUITE(DynamicPointsFilterTwin, PointTypes, );

TYPED_TEST(DynamicPointsFilterTwin, DoesAsPassThroughInEveryMode) {
  auto cloud = wavyFloor<TypeParam>();
  makeNan((*cloud)[3]);
  makeNan((*cloud)[33]);
  cloud->is_dense = false;
  const auto some = pcl::make_shared<pcl::Indices>();
  for (int i = 0; i < int(cloud->size()); i += 3) some->push_back(i);
  for (const bool negative : {false, true})
    for (const bool organised : {false, true})
      for (const bool all : {false, true})
        for (const float value : {test::kNan, 9.0f}) {
          pcl::PassThrough<TypeParam> twin(true);
          setUp(twin);
          DynamicPointsFilter<TypeParam> filter(true);
          filter.setMap(halfFreeMap());
          filter.setFrame(ScanFrame::Map);
          pcl::PointCloud<TypeParam> expected, output;
          pcl::Indices expected_indices, indices;
          const auto run = [&](pcl::FilterIndices<TypeParam>& each, auto& to, auto& to_indices) {
            each.setInputCloud(cloud);
            if (!all) each.setIndices(some);
            each.setNegative(negative);
            each.setKeepOrganized(organised);
            each.setUserFilterValue(value);
            each.filter(to);
            each.filter(to_indices);
          };
          run(twin, expected, expected_indices);
          run(filter, output, indices);
          EXPECT_EQ(indices, expected_indices);
          EXPECT_EQ(*filter.getRemovedIndices(), *twin.getRemovedIndices());
          ASSERT_EQ(output.size(), expected.size());
          EXPECT_EQ(output.width, expected.width);
          EXPECT_EQ(output.height, expected.height);
          EXPECT_EQ(output.is_dense, expected.is_dense);
          EXPECT_EQ(output.header.frame_id, expected.header.frame_id);
          for (std::size_t i = 0; i < output.size(); ++i) EXPECT_TRUE(isSame(output[i], expected[i])) << i;
          EXPECT_GT(output.size(), 100u);
        }
}

TEST(DynamicPointsFilter, MovesPointsIntoTheMapByTheSensorsPose) {
  const auto cloud = wavyFloor<pcl::PointXYZ>();
  pcl::Indices expected, indices;
  DynamicPointsFilter<pcl::PointXYZ> filter;
  filter.setMap(halfFreeMap());
  filter.setFrame(ScanFrame::Map);
  filter.setInputCloud(cloud);
  filter.filter(expected);
  auto sensed = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>(*cloud);
  sensed->sensor_origin_ << 16.0f, -8.0f, 4.0f, 0.0f;
  sensed->sensor_orientation_ = Eigen::Quaternionf(0, 0, 0, 1);  // half a turn about z
  for (auto& point : *sensed) point.getVector3fMap() << 16.0f - point.x, -8.0f - point.y, point.z - 4.0f;
  filter.setFrame(ScanFrame::Sensor);
  filter.setInputCloud(sensed);
  filter.filter(indices);
  EXPECT_LE(std::abs(int(indices.size()) - int(expected.size())), 2);  // floats at borders of cells
  EXPECT_GT(indices.size(), 500u);
}

TEST(DynamicPointsFilter, KeepsOrRemovesWhatTheMapDoesNotKnow) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->emplace_back(3.0f, 1.0f, 0.0f);    // occupied
  cloud->emplace_back(100.0f, 1.0f, 0.0f);  // no cell
  cloud->emplace_back(1e9f, 1e9f, 1e9f);    // beyond all cells
  (*cloud)[0].z = 0.2f * std::sin(9.0f);
  DynamicPointsFilter<pcl::PointXYZ> filter;
  filter.setMap(halfFreeMap());
  filter.setInputCloud(cloud);
  pcl::Indices indices;
  filter.filter(indices);
  EXPECT_EQ(indices, (pcl::Indices{0, 1, 2}));
  filter.setUnknownSpace(UnknownSpace::Remove);
  filter.filter(indices);
  EXPECT_EQ(indices, (pcl::Indices{0}));
  filter.setThreshold(1.5f);
  filter.filter(indices);
  EXPECT_TRUE(indices.empty());
}

/// How many points of moving and of static surfaces a filter has removed.
struct Removed {
  std::size_t moving = 0, all_moving = 0, still = 0, all_still = 0;
};

/// A hall of 20 m x 12 m x 4 m. A box of 2 m x 1 m x 1.8 m drives through it beside the sensor, which is slower.
std::vector<SimulatedScan> hallWithMovingBox() {
  const World hall(boxMesh({-10, -6, -1}, {10, 6, 3}), {{boxMesh({-8, 2, -0.95}, {-6, 3, 0.85}), {1.4, 0, 0}}});
  LidarOptions lidar;
  lidar.columns = 600;
  std::vector<SimulatedScan> scans;
  for (int i = 0; i < 10; ++i) {
    Pose sensor;
    sensor.translation.x() = 0.9 * i - 6.0;
    scans.push_back(simulateScan(hall, sensor, lidar, std::uint64_t(i + 1), double(i)));
  }
  return scans;
}

void countRemoved(const SimulatedScan& scan, const std::shared_ptr<const GaussianMapOctree>& map, Removed& counts) {
  DynamicPointsFilter<pcl::PointXYZ> still;  // as in the README: all options have their defaults
  still.setMap(map);
  still.setInputCloud(cloudOf<pcl::PointXYZ>(scan));
  pcl::Indices kept;
  still.filter(kept);
  std::vector<bool> is_kept(scan.points.size(), false);
  for (const auto i : kept) is_kept[std::size_t(i)] = true;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const bool moves = scan.labels[i] != SurfaceLabel::Static;
    ++(moves ? counts.all_moving : counts.all_still);
    if (!is_kept[i]) ++(moves ? counts.moving : counts.still);
  }
}

TEST(DynamicPointsFilter, RemovesAMovingBoxByAMapOfTheSameScansWithDefaults) {
  OnlineMapper<3> mapper;
  const std::vector<SimulatedScan> scans = hallWithMovingBox();
  for (const SimulatedScan& scan : scans) mapper.add({scan.points, scan.pose});
  const auto map = std::make_shared<const GaussianMapOctree>(mapper.map());
  Removed removed;
  for (const SimulatedScan& scan : scans) countRemoved(scan, map, removed);
  EXPECT_GT(removed.all_moving, 1000u);
  EXPECT_GT(double(removed.moving), 0.9 * double(removed.all_moving));
  EXPECT_LT(double(removed.still), 0.003 * double(removed.all_still));
}

TEST(DynamicPointsFilter, RemovesAMovingBoxFromScansThatTheMapDoesNotHave) {
  OnlineMapper<3> mapper;
  Removed removed;
  const std::vector<SimulatedScan> scans = hallWithMovingBox();
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i > 0) countRemoved(scans[i], std::make_shared<const GaussianMapOctree>(mapper.map()), removed);
    mapper.add({scans[i].points, scans[i].pose});
  }
  EXPECT_GT(double(removed.moving), 0.7 * double(removed.all_moving));
  // The rings of this lidar leave gaps on the floor, so one in five static points is in no cell of the map.
  EXPECT_LT(double(removed.still), 0.02 * double(removed.all_still));
}

TEST(DynamicPointsFilter, WarnsOfAMapWithoutOccupancy) {
  const auto cloud = wavyFloor<pcl::PointXYZ>();
  DynamicPointsFilter<pcl::PointXYZ> filter;
  testing::internal::CaptureStderr();
  filter.setMap(std::make_shared<GaussianMapOctree>(buildMap(*cloud)));
  EXPECT_NE(testing::internal::GetCapturedStderr().find("the map has no occupancy"), std::string::npos);
  testing::internal::CaptureStderr();
  filter.setMap(halfFreeMap());
  filter.setMap(std::make_shared<GaussianMapOctree>());  // an empty map: nothing is wrong yet
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(DynamicPointsFilter, RemovesNothingByAMapThatSawNoMiss) {
  const auto cloud = wavyFloor<pcl::PointXYZ>();
  DynamicPointsFilter<pcl::PointXYZ> filter;
  filter.setMap(std::make_shared<GaussianMapOctree>(buildMap(*cloud)));
  filter.setFrame(ScanFrame::Map);
  filter.setInputCloud(cloud);
  pcl::PointCloud<pcl::PointXYZ> output;
  filter.filter(output);
  EXPECT_EQ(output.size(), cloud->size());
}

TEST(DynamicPointsFilter, PassesNothingWithoutMapOrPose) {
  auto cloud = wavyFloor<pcl::PointXYZ>();
  DynamicPointsFilter<pcl::PointXYZ> filter(true);
  pcl::PointCloud<pcl::PointXYZ> output;
  filter.setInputCloud(cloud);
  filter.filter(output);
  EXPECT_TRUE(output.empty());
  EXPECT_EQ(filter.getRemovedIndices()->size(), cloud->size());
  filter.setMap(halfFreeMap());
  cloud->sensor_orientation_ = Eigen::Quaternionf(0, 0, 0, 0);
  filter.filter(output);
  EXPECT_TRUE(output.empty());
  auto empty = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  filter.setInputCloud(empty);
  filter.filter(output);
  EXPECT_TRUE(output.empty());
}

}  // namespace
}  // namespace gaussmap
