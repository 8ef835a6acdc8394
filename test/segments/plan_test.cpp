// SPDX-License-Identifier: BSD-3-Clause
// The simulated floor plan: true walls, faces 12 cm apart, ranges and poses with noise.
#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/wall_score.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/segments/segment_fitter.h"
#include "simulation/simulation.h"

namespace gaussmap {
using namespace detail;

namespace {

WallScore scorePlan(double pose_noise, double tolerance, std::uint64_t seed) {
  Simulation simulation = makeSimulation(WorldName::Plan);
  std::get<PlanarLaserOptions>(simulation.sensor).noise = 0.02;
  Random random(seed);
  SegmentFitter fitter;
  for (std::size_t i = 0; i < simulation.trajectory.size(); ++i) {
    const SimulatedScan simulated = simulateScan(simulation, i, seed);
    const Eigen::Vector3d ahead = simulated.pose.rotation * Eigen::Vector3d::UnitX();
    LaserScan scan;
    scan.pose.heading = std::atan2(ahead.y(), ahead.x());
    scan.pose.translation =
        simulated.pose.translation.head<2>() + pose_noise * Eigen::Vector2d(random.normal(), random.normal());
    scan.pose.covariance(0, 0) = scan.pose.covariance(1, 1) = pose_noise * pose_noise;
    for (const Eigen::Vector3d& point : simulated.points) {
      scan.bearings.push_back(std::atan2(point.y(), point.x()));
      if (scan.bearings.size() > 1 && scan.bearings.back() < scan.bearings.end()[-2])
        scan.bearings.back() = scan.bearings.end()[-2];
      scan.ranges.push_back(point.head<2>().norm());
    }
    fitter.add(scan);
  }
  std::vector<Segment> walls;
  for (const WallSegment& wall : planWalls()) {
    walls.emplace_back();
    walls.back().start = wall.from;
    walls.back().end = wall.to;
  }
  WallScoreOptions options;
  options.tolerance = tolerance;
  return scoreWalls(fitter.map(), walls, options);
}

TEST(SegmentFitterPlan, FindsTheWallsToMillimetres) {
  const WallScore score = scorePlan(0.0, 0.05, 1);
  EXPECT_GE(score.recall, 0.99);
  EXPECT_GE(score.precision, 0.99);
  EXPECT_LE(score.offset_rms, 1.5e-3);
  EXPECT_LE(score.angle_rms, 0.4 * std::acos(-1.0) / 180.0);
  EXPECT_LE(score.corner_median, 0.012);
}

TEST(SegmentFitterPlan, WithUncertainPosesKnowsHowUncertainTheWallsAre) {
  double recall = 0.0, error = 0.0;
  constexpr int kSeeds = 4;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const WallScore score = scorePlan(0.02, 0.02, static_cast<std::uint64_t>(seed));
    recall += score.recall / kSeeds;
    error += score.normalised_error / kSeeds;
  }
  EXPECT_GE(recall, 0.97);
  EXPECT_GE(error, 1.3);
  EXPECT_LE(error, 3.0);
}

}  // namespace
}  // namespace gaussmap
