// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mesh/shapes.h"
#include "simulation/lidar.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// A wall at x = 10 and a cube of 1 m that comes from y = -20 with 2 m/s, between x = 4 and 5.
World crossing() {
  const TriangleMesh wall = rectangleMesh({{10, -50, -5}, {0, 100, 0}, {0, 0, 10}});
  return World(wall, {{boxMesh({4, -20.5, -0.5}, {5, -19.5, 0.5}), {0, 2, 0}}});
}

TEST(World, HasItsMovingObjectsWhereTheyAreAtTheTime) {
  const World world = crossing();
  const Ray ahead{{0, 0, 0}, {1, 0, 0}};
  for (const double time : {0.0, 9.7, 10.3, 20.0}) {
    const auto hit = world.intersect(ahead, time, kFar);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->range, 10.0);
    EXPECT_EQ(hit->label, SurfaceLabel::Static);
  }
  for (const double time : {9.76, 10.0, 10.24}) {
    const auto hit = world.intersect(ahead, time, kFar);
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit->range, 4.0);
    EXPECT_EQ(hit->label, SurfaceLabel::Moving);
  }
  EXPECT_FALSE(world.intersect(ahead, 10.0, 3.9));
  EXPECT_FALSE(world.intersect({{0, 0, 0}, {-1, 0, 0}}, 10.0, kFar));
}

TEST(World, HidesMovingObjectsBehindStaticOnes) {
  const auto hit = crossing().intersect({{12, 0, 0}, {-1, 0, 0}}, 10.0, kFar);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->range, 2.0);
  EXPECT_EQ(hit->label, SurfaceLabel::Static);
}

TEST(World, RefusesFaults) {
  EXPECT_THROW(World({{}, {{0, 1, 2}}}), std::invalid_argument);
  EXPECT_THROW(World({}, {{boxMesh({0, 0, 0}, {1, 1, 1}), {std::nan(""), 0, 0}}}), std::invalid_argument);
  EXPECT_FALSE(World(TriangleMesh{}).intersect({{0, 0, 0}, {1, 0, 0}}, 0.0, kFar));
}

TEST(SimulatedScan, LabelsWhatItMet) {
  LidarOptions options;
  options.noise = 0.0;
  options.rings = 1;
  options.lowest_deg = options.highest_deg = 0.0;
  options.columns = 3600;
  const SimulatedScan scan = simulateScan(crossing(), Pose(), options, 1, 10.0);
  ASSERT_EQ(scan.labels.size(), scan.points.size());
  std::size_t moving = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const bool is_moving = scan.labels[i] == SurfaceLabel::Moving;
    moving += is_moving;
    EXPECT_NEAR(scan.points[i].x(), is_moving ? 4.0 : 10.0, 1e-9);
  }
  EXPECT_EQ(moving, 143u);  // atan(0.5 / 4) = 7.125 degrees to either side: 71 steps of 0.1, and the one ahead
  EXPECT_THROW(simulateScan(crossing(), Pose(), options, 1, kFar), std::invalid_argument);
}

TEST(SimulatedScan, KeepsAllOtherPointsWhenAnObjectComes) {
  const SimulatedScan empty = simulateScan(World(crossing().mesh()), Pose(), LidarOptions(), 3);
  const SimulatedScan crossed = simulateScan(crossing(), Pose(), LidarOptions(), 3, 10.0);
  std::size_t kept = 0;
  for (std::size_t i = 0, j = 0; j < crossed.points.size(); ++j) {
    if (crossed.labels[j] == SurfaceLabel::Moving) continue;
    while (i < empty.points.size() && empty.points[i] != crossed.points[j]) ++i;
    ASSERT_LT(i, empty.points.size());
    ++kept;
  }
  EXPECT_GT(kept, 10000u);
  EXPECT_LT(kept, empty.points.size());
}

TEST(SimulatedScan, GetsNothingBackFromASurfaceThatItGrazes) {  // a floor 1 m below, seen at 0.5 and 2 parts in 10^4
  const World floor(rectangleMesh({{-1e5, -1e5, -1}, {2e5, 0, 0}, {0, 2e5, 0}}));
  LidarOptions options;
  options.rings = 1;
  options.columns = 1;
  options.noise = 0.0;
  options.max_range = 1e6;
  const auto returns = [&](double angle) {
    options.lowest_deg = options.highest_deg = -angle * 180.0 / std::acos(-1.0);
    return simulateScan(floor, Pose(), options).points.size();
  };
  EXPECT_EQ(returns(0.5e-4), 0u);
  EXPECT_EQ(returns(2e-4), 1u);
}

TEST(PlanarLaser, SpreadsItsBeamsOverItsField) {
  const World tube(cylinderMesh({{0, 0, -1}, {0, 0, 2}, 5.0}, 100));
  PlanarLaserOptions options;
  options.noise = 0.0;
  const auto bearings = [&](int beams, double field) {
    options.beams = beams;
    options.field_deg = field;
    std::vector<double> degrees;
    for (const Eigen::Vector3d& point : simulateScan(tube, Pose(), options).points) {
      EXPECT_EQ(point.z(), 0.0);
      degrees.push_back(std::round(std::atan2(point.y(), point.x()) * 180.0 / std::acos(-1.0) * 1e6) / 1e6);
    }
    return degrees;
  };
  EXPECT_EQ(bearings(5, 180), (std::vector<double>{-90, -45, 0, 45, 90}));
  EXPECT_EQ(bearings(361, 180).size(), 361u);
  EXPECT_EQ(bearings(361, 180)[1], -89.5);
  EXPECT_EQ(bearings(3, 270), (std::vector<double>{-135, 0, 135}));
  const std::vector<double> turn = bearings(4, 360);
  EXPECT_EQ(std::abs(turn[0]), 180.0);
  EXPECT_EQ(std::vector<double>(turn.begin() + 1, turn.end()), (std::vector<double>{-90, 0, 90}));
  EXPECT_EQ(bearings(1, 180), std::vector<double>{0});
}

TEST(PlanarLaser, RefusesOptionsThatCannotBe) {
  const auto refused = [](auto change) {
    PlanarLaserOptions options;
    change(options);
    EXPECT_THROW(simulateScan(World(TriangleMesh{}), Pose(), options), std::invalid_argument);
  };
  refused([](PlanarLaserOptions& options) { options.beams = 0; });
  refused([](PlanarLaserOptions& options) { options.field_deg = 0.0; });
  refused([](PlanarLaserOptions& options) { options.field_deg = 361.0; });
  refused([](PlanarLaserOptions& options) { options.noise = -1.0; });
  refused([](PlanarLaserOptions& options) { options.max_range = 0.0; });
}

}  // namespace
}  // namespace gaussmap
