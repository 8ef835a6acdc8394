// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "mapping/online/online_scenes.h"

namespace gaussmap {
namespace {

using namespace test;

/// Gaussians of a scale in front of x = 8: those of the box.
std::size_t inFront(const GaussianMap<3>& map, int scale) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < map.gaussianCount(scale); ++i) count += map.gaussian(i, scale).mean.x() < 8.0;
  return count;
}

TEST(Forget, DeletesAnObjectThatLeftAfterTheViewsThatTheLogOddsDemand) {
  OnlineMapper<3> mapper(wallOptions());
  mapper.add(wallScan(true));
  mapper.add(wallScan(true));
  const GaussianMap<3> before = mapper.map();
  for (int s = 0; s < 3; ++s) ASSERT_GT(inFront(before, s), 0u);
  // Two hits give 1.7, a miss takes 0.4: four are not enough, the fifth is.
  for (int view = 0; view < 4; ++view) {
    EXPECT_EQ(mapper.add(wallScan(false)).deleted, 0u) << view;
    EXPECT_EQ(inFront(mapper.map(), 0), inFront(before, 0));
  }
  EXPECT_GE(mapper.add(wallScan(false)).deleted, inFront(before, 0));
  for (int s = 0; s < 3; ++s) EXPECT_EQ(inFront(mapper.map(), s), 0u) << s;
}

TEST(Forget, LeavesTheWallBehindWhole) {
  OnlineMapper<3> mapper(wallOptions()), undisturbed(wallOptions());
  for (int i = 0; i < 2; ++i) mapper.add(wallScan(true));
  for (int i = 0; i < 8; ++i) {
    mapper.add(wallScan(false));
    undisturbed.add(wallScan(false));
  }
  for (int s = 0; s < 3; ++s) EXPECT_EQ(mapper.map().scale(s).keys, undisturbed.map().scale(s).keys) << s;
}

TEST(Forget, DeletesNothingWhereNothingMoves) {
  OnlineOptions options = wallOptions();
  options.look_back = 10;
  OnlineMapper<3> mapper(options);
  std::size_t deleted = 0, finest = 0;
  for (const Scan& scan : hallScans(10)) {
    deleted += mapper.add(scan).deleted;
    finest = mapper.map().gaussianCount(0);
  }
  EXPECT_LE(deleted, finest / 1000);
}

TEST(Forget, ACellThatIsNewBetweenTwoLooksCountsAsHit) {
  OnlineOptions options = wallOptions();
  options.occupancy_every = 3;
  options.look_back = 10;
  OnlineMapper<3> mapper(options);
  mapper.add(wallScan(false));
  mapper.add(wallScan(true));  // not looked around, but looked back: one hit, one miss
  EXPECT_GT(inFront(mapper.map(), 0), 0u);
}

TEST(Forget, TheBudgetShrinksWithTheMap) {
  // Small things that have one cluster in each of their coarse cells; when they go, the budget falls by more.
  OnlineOptions options = wallOptions();
  options.refine_every = 1;
  options.budget = 2.0;
  OnlineMapper<3> mapper(options);
  Scan first = wallScan(false);
  for (int y = -3; y < 3; ++y)
    for (int z = -1; z < 1; ++z)
      for (int i = 0; i < 9; ++i) first.points.push_back({5.1, y + 0.45 + 0.03 * (i % 3), z + 0.45 + 0.03 * (i / 3)});
  mapper.add(first);
  for (int i = 0; i < 8; ++i) mapper.add(wallScan(false));
  const GaussianMap<3> map = mapper.map();
  ASSERT_EQ(inFront(map, 0), 0u);
  for (int s = 1; s < 3; ++s) EXPECT_LE(map.gaussianCount(s), 2 * map.cellCount(s)) << "scale " << s;
}

TEST(Forget, ACellWithAPointIsHitThoughItsMeanIsSeenThrough) {
  // Many points at one side of a near cell, then one at the other side: the beams pass its mean, but something is
  // there.
  Scan many = wallScan(false), one = wallScan(false);
  for (int i = 0; i < 50; ++i) many.points.push_back({1.1, 0.02 + 0.0002 * i, 0.1});
  one.points.push_back({1.1, 0.18, 0.1});
  OnlineMapper<3> mapper(wallOptions());
  mapper.add(many);
  for (int i = 0; i < 3; ++i) mapper.add(one);
  for (int i = 0; i < 8; ++i) mapper.add(wallScan(false));  // four hits give 3.4, eight misses take 3.2
  EXPECT_EQ(inFront(mapper.map(), 0), 1u);
  mapper.add(wallScan(false));
  EXPECT_EQ(inFront(mapper.map(), 0), 0u);
}

TEST(Forget, AnObjectReachesOnlySoFarBeyondItsFreedCells) {
  // A pole hangs from the box down to where later scans see nothing.
  Scan first = wallScan(true);
  for (int i = 0; i < 190; ++i) first.points.push_back({5.1, 0.0, -0.6 - 0.01 * i});
  OnlineOptions options = wallOptions();
  options.projection = findProjection(wallScan(false).points);
  OnlineMapper<3> mapper(options);
  mapper.add(first);
  for (int i = 0; i < 6; ++i) mapper.add(wallScan(false));
  const GaussianMap<3> map = mapper.map();
  double highest = -10.0;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i)
    if (map.gaussian(i, 0).mean.x() < 8.0) highest = std::max(highest, map.gaussian(i, 0).mean.z());
  EXPECT_LT(highest, -0.9);
  EXPECT_GT(highest, -1.9);
}

TEST(Forget, ASensorThatSeesMoreThanTheOneBeforeIsUnderstood) {
  LidarOptions narrow = wallLidar();
  narrow.lowest_deg = 4.0;
  OnlineMapper<3> mapper(wallOptions());
  mapper.add(boxScan({}, narrow));
  mapper.add(wallScan(true));  // the box is lower than the first sensor looked
  for (int i = 0; i < 4; ++i) mapper.add(wallScan(false));
  EXPECT_EQ(inFront(mapper.map(), 0), 0u);
}

TEST(Forget, ASensorOfFewerBeamsThanTheOneBeforeIsUnderstood) {
  LidarOptions sparse = wallLidar();
  sparse.columns = 180;
  OnlineMapper<3> mapper(wallOptions());
  mapper.add(wallScan(false));
  mapper.add(boxScan({-0.5}, sparse));
  for (int i = 0; i < 4; ++i) mapper.add(boxScan({}, sparse));
  EXPECT_EQ(inFront(mapper.map(), 0), 0u);
}

TEST(Forget, WhatWasRestoredIsNotForgottenAtTheNextLook) {
  std::vector<RemovedCluster<3>> removed;
  OnlineMapper<3> mapper(wallOptions(), [&](const RemovedCluster<3>& cluster) { removed.push_back(cluster); });
  mapper.add(wallScan(true));
  const std::size_t box = inFront(mapper.map(), 0);
  for (int i = 0; i < 4; ++i) mapper.add(wallScan(false));
  for (const RemovedCluster<3>& cluster : removed)
    if (cluster.scale == 0) mapper.restore(cluster);
  for (int i = 0; i < 4; ++i) mapper.add(wallScan(false));
  EXPECT_EQ(inFront(mapper.map(), 0), box);
}

TEST(Forget, LookingBackFindsWhatWasNotThereBefore) {
  // The object comes late: later scans cannot disprove it, earlier ones can.
  for (const int look_back : {0, 10}) {
    OnlineOptions options = wallOptions();
    options.look_back = look_back;
    OnlineMapper<3> mapper(options);
    for (int i = 0; i < 6; ++i) mapper.add(wallScan(false));
    mapper.add(wallScan(true));
    EXPECT_EQ(inFront(mapper.map(), 0) == 0, look_back > 0);
  }
}

TEST(Forget, ARangeImageThatIsNoEvidenceDeletesNothing) {
  OnlineMapper<3> mapper(wallOptions());
  mapper.add(wallScan(true));
  const std::size_t before = mapper.map().gaussianCount(0);
  for (int i = 0; i < 20; ++i) mapper.add({});
  EXPECT_EQ(mapper.map().gaussianCount(0), before);
}

TEST(Forget, BeyondTheRangeOfTheFinestScaleNothingIsLookedAt) {
  OnlineOptions options = wallOptions();
  options.max_ranges = {4.0};
  OnlineMapper<3> mapper(options);
  mapper.add(wallScan(true));
  const std::size_t before = inFront(mapper.map(), 0);
  for (int i = 0; i < 8; ++i) mapper.add(wallScan(false));
  EXPECT_EQ(inFront(mapper.map(), 0), before);
}

TEST(Forget, SamplesDecideAsTheMeanDoes) {
  OnlineOptions options = wallOptions();
  options.samples = OccupancySamples::Random;
  OnlineMapper<3> mapper(options), undisturbed(wallOptions());
  mapper.add(wallScan(true));
  for (int i = 0; i < 8; ++i) {
    mapper.add(wallScan(false));
    undisturbed.add(wallScan(false));
  }
  EXPECT_EQ(mapper.map().scale(0).keys, undisturbed.map().scale(0).keys);
}

TEST(Forget, SaysWhyEachClusterWasDeleted) {
  std::vector<RemovedCluster<3>> removed;
  OnlineMapper<3> mapper(wallOptions(), [&](const RemovedCluster<3>& cluster) { removed.push_back(cluster); });
  mapper.add(wallScan(true));
  for (int i = 0; i < 5; ++i) mapper.add(wallScan(false));
  ASSERT_FALSE(removed.empty());
  bool coarse = false;
  for (const RemovedCluster<3>& cluster : removed) {
    EXPECT_LT(cluster.gaussian.mean.x(), 8.0);
    EXPECT_EQ(cluster.evidence.hits, 1u);
    EXPECT_EQ(cluster.evidence.first_hit, 0u);
    EXPECT_EQ(cluster.evidence.last_hit, 0u);
    if (cluster.scale == 0) {
      EXPECT_EQ(double(cluster.moments.count), cluster.gaussian.weight);
    }
    coarse |= cluster.scale == 2;
  }
  EXPECT_TRUE(coarse);
}

TEST(Forget, RestoringBringsTheMapBackToTheLastBit) {
  std::vector<RemovedCluster<3>> removed;
  OnlineMapper<3> mapper(wallOptions(), [&](const RemovedCluster<3>& cluster) { removed.push_back(cluster); });
  OnlineOptions keep = wallOptions();
  keep.forget = false;
  OnlineMapper<3> keeper(keep);
  for (int i = 0; i < 8; ++i) {
    mapper.add(wallScan(i < 2));
    keeper.add(wallScan(i < 2));
  }
  ASSERT_NE(mapper.map().scale(0).keys, keeper.map().scale(0).keys);
  for (const RemovedCluster<3>& cluster : removed) {
    if (cluster.scale == 0)
      mapper.restore(cluster);
    else
      EXPECT_THROW(mapper.restore(cluster), std::invalid_argument);
  }
  const GaussianMapOctree restored = mapper.map(), kept = keeper.map();
  EXPECT_EQ(restored.scale(0).keys, kept.scale(0).keys);
  EXPECT_EQ(restored.scale(0).moments, kept.scale(0).moments);
  EXPECT_DOUBLE_EQ(mapper.map().weight(2), keeper.map().weight(2));
}

TEST(Forget, MemoryStaysFlatWhenTheSameScansComeAgainAndAgain) {
  OnlineOptions options = wallOptions();
  options.look_back = 3;
  OnlineMapper<3> mapper(options);
  std::size_t early = 0;
  for (int round = 0; round < 40; ++round) {
    for (const int i : {0, 1, 2, 3, 4, 5, 6}) mapper.add(wallScan(i < 1));
    if (round == 3) early = mapper.memoryBytes();
  }
  EXPECT_LE(mapper.memoryBytes(), early + early / 50);
}

TEST(Forget, ClustersThatLearnByThemselvesAreForgottenAtEveryScaleToo) {
  OnlineOptions options = wallOptions();
  options.learning_rate = LearningRate::Occupancy;
  options.refine_every = 1;
  options.refine_cells = 20;
  OnlineMapper<3> mapper(options);
  for (int i = 0; i < 2; ++i) mapper.add(wallScan(true));
  for (int i = 0; i < 6; ++i) mapper.add(wallScan(false));
  for (int s = 0; s < 3; ++s) EXPECT_EQ(inFront(mapper.map(), s), 0u) << s;
}

}  // namespace
}  // namespace gaussmap
