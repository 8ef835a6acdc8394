// SPDX-License-Identifier: BSD-3-Clause
// What a box that went away leaves in the cells that it shared with the floor.
#include <gtest/gtest.h>

#include <cmath>

#include "mapping/online/online_scenes.h"
#include "mapping/online/online_state.h"

namespace gaussmap {
using namespace detail;

namespace {

using namespace test;

constexpr double kFloor = -1.5;  // [m], inside the cells from -1.6 to -1.4

/// From the origin: a floor, a wall behind it, and perhaps a box of 1 m that stands on the floor. Three in four
/// scans see the floor in other places, as those of a sensor that moves would.
Scan floorScan(bool with_box, int number) {
  LidarOptions lidar;
  lidar.rings = 120;
  lidar.lowest_deg = -30.0;
  lidar.highest_deg = 5.0;
  lidar.columns = 1440;
  lidar.noise = 0.0;
  std::vector<Rectangle> rectangles = {{{2.0, -6.0, kFloor}, {12.1, 0.0, 0.0}, {0.0, 12.0, 0.0}},
                                       {{14.1, -6.0, kFloor}, {0.0, 12.0, 0.0}, {0.0, 0.0, 4.0}}};
  if (with_box) {
    rectangles.push_back({{5.1, -0.5, kFloor}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}});
    rectangles.push_back({{5.1, -0.5, kFloor + 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}});
  }
  Pose pose;
  pose.translation = {0.03 * (number % 4), 0.02 * (number % 4), 0.0};
  return asScan(simulateScan(worldOf(rectangles), pose, lidar));
}

OnlineOptions floorOptions() {
  OnlineOptions options = wallOptions();
  options.look_back = 10;
  return options;
}

/// Highest deviation from the floor [m] that the Gaussians of the floor's cells under the box say.
double worstOfFloor(const GaussianMapOctree& map) {
  double worst = 0.0;
  int cells = 0;
  for (double y = -0.7; y < 0.75; y += 0.2)
    for (const double x : {4.9, 5.1, 5.3}) {
      const auto cell = map.find(map.grid().keyOf({x, y, kFloor}), 0);
      if (!cell) continue;
      ++cells;
      const Gaussian<3> gaussian = map.gaussian(*cell, 0);
      const double noise = map.options().noise;
      const double up = gaussian.mean.z() - kFloor;
      worst = std::max(worst, std::sqrt(gaussian.cov(2, 2) - noise * noise + up * up));
    }
  EXPECT_GT(cells, 10);
  return worst;
}

TEST(SplitShared, TheFloorIsFlatAgainWhenABoxHasGone) {
  OnlineMapper<3> splits(floorOptions());
  OnlineOptions without = floorOptions();
  without.look_back = 0;  // nothing is remembered
  OnlineMapper<3> leaves(without);
  for (int i = 0; i < 9; ++i) {
    splits.add(floorScan(i < 2, i));
    leaves.add(floorScan(i < 2, i));
  }
  EXPECT_FALSE(splits.map().find(splits.map().grid().keyOf({5.1, 0.0, -1.0}), 0));
  EXPECT_LT(worstOfFloor(splits.map()), 1e-3);
  for (int s = 1; s < 3; ++s) EXPECT_DOUBLE_EQ(splits.map().weight(s), splits.map().weight(0));
  EXPECT_GT(worstOfFloor(leaves.map()), 0.02);
}

TEST(SplitShared, TheFloorInFrontOfTheBoxKeepsEveryPoint) {  // beside its cells, but on the surface
  OnlineOptions keep = floorOptions();
  keep.forget = false;
  OnlineMapper<3> mapper(floorOptions()), keeper(keep);
  for (int i = 0; i < 9; ++i) {
    mapper.add(floorScan(i < 2, i));
    keeper.add(floorScan(i < 2, i));
  }
  const GaussianMapOctree map = mapper.map(), all = keeper.map();
  int cells = 0;
  for (double y = -0.5; y < 0.55; y += 0.2) {
    const CellKey<3> key = map.grid().keyOf({4.9, y, kFloor});
    const auto cell = map.find(key, 0), whole = all.find(key, 0);
    ASSERT_EQ(cell.has_value(), whole.has_value());
    if (!cell) continue;
    ++cells;
    EXPECT_EQ(map.scale(0).moments[*cell], all.scale(0).moments[*whole]);
  }
  EXPECT_GE(cells, 4);
}

TEST(SplitShared, WhatWentWithItsCellIsNotRemembered) {  // else it would be subtracted from what comes there later
  OnlineCells<3> cells(Grid<3>({0.2, 5, 3, 0.0}));
  const CellKey<3> key{3, 4, 5}, other{9, 9, 9};
  std::deque<ScanSums<3>> recent;
  for (std::uint32_t number = 0; number < 3; ++number) {
    recent.push_back({number, MomentGrid<3>(0.2)});
    recent.back().sums.addPoints({cells.grid().centre(key, 0), cells.grid().centre(other, 0)});
  }
  OnlineStatistics statistics;
  splitSharedCells<3>(cells, {}, {{key, {}, -1.0f}}, recent, floorOptions(), {}, statistics);
  for (const ScanSums<3>& scan : recent) {
    EXPECT_EQ(*scan.sums.find(key), CellMoments<3>());
    EXPECT_EQ(scan.sums.find(other)->count, 1);
    EXPECT_EQ(scan.sums.pointCount(), 1);
  }
  EXPECT_EQ(statistics.deleted, 0u);
}

TEST(SplitShared, ABoxThatComesLeavesNothingInAFloorSeenBefore) {  // deleted by looking back, scan by scan
  OnlineMapper<3> mapper(floorOptions());
  for (int i = 0; i < 9; ++i) mapper.add(floorScan(i >= 6, i));
  EXPECT_FALSE(mapper.map().find(mapper.map().grid().keyOf({5.1, 0.0, -1.0}), 0));
  EXPECT_LT(worstOfFloor(mapper.map()), 1e-3);
}

TEST(SplitShared, WhatWasTakenOutIsToldAndComesBackExactly) {
  std::vector<RemovedCluster<3>> removed;
  OnlineMapper<3> mapper(floorOptions(), [&](const RemovedCluster<3>& cluster) { removed.push_back(cluster); });
  OnlineOptions keep = floorOptions();
  keep.forget = false;
  OnlineMapper<3> keeper(keep);
  std::size_t told = 0;
  for (int i = 0; i < 18; ++i) {  // the box comes and goes twice
    told += mapper.add(floorScan(i % 9 < 2, i)).deleted;
    keeper.add(floorScan(i % 9 < 2, i));
  }
  EXPECT_EQ(told, removed.size());
  const GaussianMapOctree map = mapper.map();
  std::size_t parts = 0;
  for (const RemovedCluster<3>& cluster : removed) {
    if (cluster.scale > 0) continue;
    const bool is_part = map.find(cluster.key, 0).has_value();
    parts += is_part;
    EXPECT_GT(cluster.moments.count, 0);
    EXPECT_GT(cluster.evidence.hits, 0u);
    EXPECT_LE(cluster.evidence.first_hit, cluster.evidence.last_hit);
    mapper.restore(cluster);
  }
  EXPECT_GT(parts, 5u);
  const GaussianMapOctree restored = mapper.map(), kept = keeper.map();
  EXPECT_EQ(restored.scale(0).keys, kept.scale(0).keys);
  EXPECT_EQ(restored.scale(0).moments, kept.scale(0).moments);
}

TEST(SplitShared, WithoutASurfaceNothingIsTaken) {  // the box alone, in the air, then gone
  std::size_t parts = 0;
  OnlineMapper<3> mapper(floorOptions(), [&](const RemovedCluster<3>& cluster) {
    parts += cluster.scale == 0 && cluster.key[0] > 40;  // the wall is at x = 10.1
  });
  for (int i = 0; i < 8; ++i) mapper.add(wallScan(i < 2));
  EXPECT_EQ(parts, 0u);
}

TEST(SplitShared, HasTheSameBytesAtAnyNumberOfThreads) {
  std::vector<GaussianMapOctree> maps;
  for (const int threads : {1, 2}) {
    OnlineOptions options = floorOptions();
    options.threads = threads;
    OnlineMapper<3> mapper(options);
    for (int i = 0; i < 6; ++i) mapper.add(floorScan(i < 2, i));
    maps.push_back(mapper.map());
  }
  expectSameMap<3>(maps[0], maps[1]);
}

}  // namespace
}  // namespace gaussmap
