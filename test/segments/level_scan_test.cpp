// SPDX-License-Identifier: BSD-3-Clause
#include "segments/level_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gaussmap/core/error.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Scan scanOf(std::vector<Eigen::Vector3d> points, const Pose& pose = {}) {
  Scan scan;
  scan.points = std::move(points);
  scan.pose = pose;
  return scan;
}
Pose turned(const Eigen::Vector3d& translation, double angle, const Eigen::Vector3d& axis) {
  Pose pose;
  pose.translation = translation;
  pose.rotation = Pose::Rotation(Eigen::AngleAxisd(angle, axis.normalized()));
  return pose;
}

TEST(LevelScan, KeepsThePointsOfALevelSensorBitForBit) {
  const Pose pose = turned({1, 2, 0.7}, 0.3, {0, 0, 1});
  const Scan level = levelled(scanOf({{0.1, 0.2, 0.0}, {kNaN, kNaN, kNaN}, {3, 4, 0.1}}, pose));
  EXPECT_EQ(level.points[0], Eigen::Vector3d(0.1, 0.2, 0.0));
  EXPECT_TRUE(std::isnan(level.points[1].x()));
  EXPECT_EQ(level.points[2], Eigen::Vector3d(3, 4, 0));
  EXPECT_EQ(level.pose.translation, Eigen::Vector3d(1, 2, 0));
  EXPECT_TRUE(level.pose.rotation.coeffs() == pose.rotation.coeffs());
}

TEST(LevelScan, KeepsTheMapCoordinatesOfATiltedSensor) {
  const Scan scan = scanOf({{1, 0, 0}, {0, 2, 0}, {-1, -1, 0}}, turned({5, 6, 1}, 0.4, {0.1, 0.2, 1}));
  const Scan level = levelled(scan);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    EXPECT_EQ(level.points[i].z(), 0.0);
    EXPECT_NEAR(((level.pose * level.points[i]) - (scan.pose * scan.points[i])).head<2>().norm(), 0.0, 1e-12);
    EXPECT_EQ((level.pose * level.points[i]).z(), 0.0);
  }
}

TEST(LevelScan, CutsASliceOfTheMapWithItsBorders) {
  PlanarScanOptions slice;
  slice.slice = true;
  slice.z_min = 1.0;
  slice.z_max = 2.0;
  const Scan level =
      levelled(scanOf({{1, 0, -0.5}, {1, 0, 0}, {1, 0, 1}, {1, 0, 1.0001}}, turned({0, 0, 1}, 0, {0, 0, 1})), slice);
  EXPECT_TRUE(std::isnan(level.points[0].x()));
  EXPECT_EQ(level.points[1].x(), 1.0);
  EXPECT_EQ(level.points[2].x(), 1.0);
  EXPECT_TRUE(std::isnan(level.points[3].x()));
}

TEST(LevelScan, RefusesScansInSpace) {
  EXPECT_NO_THROW(levelled(scanOf({{1, 0, 0}, {2, 0, 0.5}, {kNaN, 0, 9}, {0, 0, 0}})));
  EXPECT_THROW(levelled(scanOf({{1, 0, 0}, {2, 0, 0.51}})), std::invalid_argument);
  // Heights are those of the map: a level sensor on its side sees a plane of 2 m.
  EXPECT_THROW(levelled(scanOf({{1, 1, 0}, {1, -1, 0}}, turned({0, 0, 0}, 1.5, {1, 0, 0}))), std::invalid_argument);
}

TEST(LevelScan, ChecksScansWhileTheyAreRead) {
  const MemoryScans planar({scanOf({{1, 0, 0.1}, {2, 0, 0.3}}), scanOf({{1, 0, 7}, {2, 0, 7.4}})});
  EXPECT_EQ(accumulateScans<2>(PlanarLaserScans(planar), {}).counts.accepted, 4);
  const MemoryScans in_space({scanOf({{1, 0, 0.1}}), scanOf({{1, 0, 0}, {2, 0, 0.6}})});
  try {
    accumulateScans<2>(PlanarLaserScans(in_space), {});
    FAIL();
  } catch (const FileError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("scan 1: not a scan of a planar laser: the heights of its points in the map are 0 m to 0.6 m"),
              std::string::npos)
        << text;
  }
}

TEST(LevelScan, TurnsBeamsIntoPoints) {
  LaserScan beams;
  beams.pose.translation = {1, 2};
  beams.pose.heading = 0.5;
  beams.bearings = {0.0, 1.0};
  beams.ranges = {3.0, kNaN};
  const Scan scan = scanOfBeams(beams);
  ASSERT_EQ(scan.points.size(), 2u);
  EXPECT_NEAR(((scan.pose * scan.points[0]).head<2>() - beams.hit(0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(scan.points[0].z(), 0.0);
  EXPECT_FALSE(isReturn(scan.points[1]));
}

}  // namespace
}  // namespace gaussmap
