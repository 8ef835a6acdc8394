// SPDX-License-Identifier: BSD-3-Clause
// A robot that never stops: 2,000 scans of a room where a box stands here and there.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "mapping/online/online_scenes.h"
#include "sanitized.h"

namespace gaussmap::test {
namespace {

constexpr int kScans = kSanitized ? 400 : 2000;
constexpr int kRound = 100;  // scans until the robot is where it was

/// Walls and floor of 12 m x 8 m; the box changes its place ten times a round.
Scan roomScan(int i) {
  std::vector<detail::Rectangle> room = {{{-6, -4, 0}, {12, 0, 0}, {0, 8, 0}},
                                         {{-6, -4, 0}, {12, 0, 0}, {0, 0, 3}},
                                         {{-6, 4, 0}, {12, 0, 0}, {0, 0, 3}},
                                         {{-6, -4, 0}, {0, 8, 0}, {0, 0, 3}},
                                         {{6, -4, 0}, {0, 8, 0}, {0, 0, 3}}};
  const double place = 0.8 * (i % kRound / (kRound / 10)) - 4.0;
  room.push_back({{place, 1.5, 0.2}, {0.7, 0.0, 0.0}, {0.0, 0.0, 1.0}});
  const double turn = 6.283185307 * (i % kRound) / kRound;
  Pose pose;
  pose.translation = {3.0 * std::cos(turn), 1.0 * std::sin(turn), 1.2};
  pose.rotation = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ());
  LidarOptions lidar;
  lidar.rings = 8;
  lidar.columns = 90;
  lidar.threads = 1;
  return asScan(simulateScan(worldOf(room), pose, lidar, static_cast<std::uint64_t>(i)));
}

std::size_t peakBytes() {
  struct rusage usage;
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

void expectSound(const GaussianMap<3>& map, double budget) {
  for (int s = 0; s < map.scales(); ++s) {
    if (s > 0) {
      EXPECT_LE(static_cast<double>(map.gaussianCount(s)), budget * static_cast<double>(map.cellCount(s)));
    }
    std::size_t bad = 0;
    for (std::size_t i = 0; i < map.gaussianCount(s); ++i) {
      const Gaussian<3> gaussian = map.localGaussian(i, s);
      bad += !(gaussian.mean.allFinite() && gaussian.weight > 0.0 && std::isfinite(gaussian.weight) &&
               std::isfinite(map.logOdds(i, s)) && gaussian.cov.allFinite() &&
               Eigen::LLT<Matrix<3>>(gaussian.cov).info() == Eigen::Success);
    }
    EXPECT_EQ(bad, 0u) << s;
  }
}

struct Figures {
  std::size_t held = 0, peak = 0, cells = 0, gaussians = 0;
};

Figures figuresOf(const OnlineMapper<3>& mapper, const GaussianMap<3>& map) {
  Figures now{mapper.memoryBytes(), peakBytes(), 0, 0};
  for (int s = 0; s < map.scales(); ++s) now.cells += map.cellCount(s), now.gaussians += map.gaussianCount(s);
  return now;
}

OnlineOptions soakOptions(LearningRate rate) {
  OnlineOptions options;
  options.map = {0.2, 5, 3, 0.0};
  options.learning_rate = rate;
  options.budget = 2.0;
  options.threads = 1;
  return options;
}

class Soak : public testing::TestWithParam<LearningRate> {};

TEST_P(Soak, LeavesMemoryWeightsAndNumbersAsTheyWere) {
  const OnlineOptions options = soakOptions(GetParam());
  double removed = 0.0;
  OnlineMapper<3> mapper(options, [&](const RemovedCluster<3>& cluster) {
    if (cluster.scale == 0) removed += cluster.gaussian.weight;
  });
  std::int64_t points = 0;
  Figures half;
  for (int i = 0; i < kScans; ++i) {
    points += mapper.add(roomScan(i)).points.accepted;
    if ((i + 1) % (kScans / 4) != 0) continue;
    const GaussianMap<3> map = mapper.map();
    expectSound(map, options.budget);
    // Every point is in the map or was reported as removed.
    for (int s = 0; s < 3; ++s) EXPECT_NEAR(map.weight(s), static_cast<double>(points) - removed, 1e-6) << i;
    if (i + 1 == kScans / 2) half = figuresOf(mapper, map);
  }
  EXPECT_GT(points, kScans * 500);
  EXPECT_GT(removed, 1000.0);
  const Figures full = figuresOf(mapper, mapper.map());
  const auto few = [](std::size_t before) { return before + before / 20; };
  EXPECT_LE(full.cells, few(half.cells));
  EXPECT_LE(full.gaussians, few(half.gaussians));
  EXPECT_LE(full.held, few(half.held));
  EXPECT_LE(full.peak, half.peak + half.peak / 20);
}

INSTANTIATE_TEST_SUITE_P(OnLine, Soak, testing::Values(LearningRate::SampleMean, LearningRate::Occupancy),
                         [](const auto& rate) {
                           return rate.param == LearningRate::SampleMean ? "ExactMoments" : "ByOccupancy";
                         });

}  // namespace
}  // namespace gaussmap::test
