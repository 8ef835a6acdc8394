// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lidar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/mesh_distance.h"
#include "mesh/shapes.h"
#include "simulation/worlds.h"

namespace gaussmap {
using namespace detail;
using namespace simulation;

namespace {

Eigen::Vector3d onMap(const SimulatedScan& scan, std::size_t i) {
  return scan.pose * scan.points[i];
}

TEST(SimulatedScan, WithoutNoiseLiesOnTheMesh) {
  const World world(cornerMesh());
  const MeshDistance truth(world.mesh());
  LidarOptions options;
  options.noise = 0.0;
  for (const Pose& pose : cornerTrajectory()) {
    const SimulatedScan scan = simulateScan(world, pose, options);
    ASSERT_EQ(scan.points.size(), scan.truth.size());
    EXPECT_GT(scan.points.size(), 15000u);
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      ASSERT_LT(truth.distance(onMap(scan, i)), 1e-9);
      ASSERT_LT((onMap(scan, i) - scan.truth[i]).norm(), 1e-9);
    }
  }
}

TEST(SimulatedScan, HasNormalNoiseAlongItsRays) {
  LidarOptions options;
  options.noise = 0.02;
  const Pose pose = cornerTrajectory().front();
  const SimulatedScan scan = simulateScan(World(cornerMesh()), pose, options);
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const double range = (scan.truth[i] - pose.translation).norm(), noise = scan.points[i].norm() - range;
    ASSERT_LT((onMap(scan, i) - scan.truth[i]).norm() - std::abs(noise), 1e-9);  // along the ray only
    sum += noise;
    squares += noise * noise;
  }
  const auto count = static_cast<double>(scan.points.size());
  EXPECT_NEAR(sum / count, 0.0, 5 * 0.02 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.02, 0.0005);
}

TEST(SimulatedScan, ArrivesColumnByColumnAndRingByRing) {
  // In the middle of a shaft every ray comes back: rings at -10, 0, 10 degrees, 4 columns a right angle apart.
  const World shaft(boxMesh({-2, -2, -5}, {2, 2, 5}));
  LidarOptions options;
  options.rings = 3;
  options.lowest_deg = -10;
  options.highest_deg = 10;
  options.columns = 4;
  options.noise = 0.0;
  const SimulatedScan scan = simulateScan(shaft, Pose(), options);
  ASSERT_EQ(scan.points.size(), 12u);
  const double height = 2.0 * std::tan(10.0 * std::acos(-1.0) / 180.0);
  const Eigen::Vector3d across[] = {{2, 0, 0}, {0, 2, 0}, {-2, 0, 0}, {0, -2, 0}};
  for (std::size_t i = 0; i < 12; ++i) {
    const Eigen::Vector3d expected = across[i / 3] + Eigen::Vector3d(0, 0, (double(i % 3) - 1.0) * height);
    EXPECT_LT((scan.points[i] - expected).norm(), 1e-12) << i;
  }
}

TEST(SimulatedScan, LeavesOutWhatIsOutOfRange) {
  const World wall(rectangleMesh({{10, -50, -50}, {0, 100, 0}, {0, 0, 100}}));
  LidarOptions options;
  options.rings = 1;
  options.lowest_deg = options.highest_deg = 0.0;
  options.columns = 360;
  options.noise = 0.0;
  options.max_range = 20.0;  // cos 60 = 10 / 20: azimuths -60 ... 60, of which the two last are on the limit
  const std::size_t returns = simulateScan(wall, Pose(), options).points.size();
  EXPECT_GE(returns, 119u);
  EXPECT_LE(returns, 121u);
  options.max_range = 9.9;
  EXPECT_TRUE(simulateScan(wall, Pose(), options).points.empty());
}

TEST(SimulatedScan, IsTheSameForTheSameSeedWithAnyNumberOfThreads) {
  LidarOptions options;
  options.threads = 1;
  const Pose pose = cornerTrajectory()[2];
  const SimulatedScan one = simulateScan(World(cornerMesh()), pose, options, 7);
  options.threads = 2;
  EXPECT_EQ(one.points, simulateScan(World(cornerMesh()), pose, options, 7).points);
  EXPECT_NE(one.points, simulateScan(World(cornerMesh()), pose, options, 8).points);
}

TEST(SimulatedScan, RefusesOptionsAndPosesThatCannotBe) {
  const auto refused = [](auto change) {
    LidarOptions options;
    change(options);
    EXPECT_THROW(simulateScan(World({}), Pose(), options), std::invalid_argument);
  };
  refused([](LidarOptions& options) { options.rings = 0; });
  refused([](LidarOptions& options) { options.columns = -1; });
  refused([](LidarOptions& options) { options.noise = -0.1; });
  refused([](LidarOptions& options) { options.max_range = 0.0; });
  refused([](LidarOptions& options) { options.highest_deg = 90.0; });
  refused([](LidarOptions& options) { options.lowest_deg = 20.0; });
  Pose tilted;
  tilted.rotation.coeffs() *= 2.0;
  EXPECT_THROW(simulateScan(World({}), tilted), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
