// SPDX-License-Identifier: BSD-3-Clause
#include "segments/segment_store.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace gaussmap::detail {
namespace {

/// Enters a segment along x, at y = 0, its free side above.
int addWall(double from, double to, SegmentStore& store) {
  const int id = store.create();
  LiveSegment& segment = store[id];
  segment.evidence.row = CellRow({from, 0.0}, {1.0, 0.0}, 0.1);
  for (double x = from + 0.01; x < to; x += 0.02) segment.evidence.row.add({x, 0.0}, 1.0);
  segment.view = {0.0, 1.0};
  refit(segment);
  store.enter(id);
  return id;
}

bool isNear(const SegmentStore& store, const Vector<2>& point, int id) {
  const std::vector<int>& near = store.near(point);
  return std::find(near.begin(), near.end(), id) != near.end();
}

TEST(SegmentStore, FindsSegmentsByPlaceUntilTheyAreDeleted) {
  SegmentStore store{SegmentFitterOptions()};
  const int wall = addWall(0.0, 2.0, store);
  EXPECT_TRUE(isNear(store, {1.0, 0.05}, wall));
  EXPECT_FALSE(isNear(store, {1.0, 5.0}, wall));
  store.remove(wall);
  EXPECT_FALSE(isNear(store, {1.0, 0.05}, wall));
  EXPECT_FALSE(store[wall].alive);
}

TEST(SegmentStore, UsesTheNumbersOfDeletedSegmentsAgain) {
  SegmentStore store{SegmentFitterOptions()};
  const int first = addWall(0.0, 1.0, store), second = addWall(2.0, 3.0, store);
  store.remove(first);
  EXPECT_EQ(addWall(4.0, 5.0, store), first);
  EXPECT_EQ(store.segments().size(), 2u);
  EXPECT_TRUE(store[second].alive);
}

TEST(SegmentStore, SplitsAndMergesWithinTheChain) {
  SegmentStore store{SegmentFitterOptions()};
  const int wall = addWall(0.0, 2.0, store), next = addWall(2.0, 3.0, store);
  link(wall, next, store.segments());
  const int part = store.split(wall, 10, true);  // cells of 0.1 m
  EXPECT_NEAR(store[wall].finish().x(), 1.0, 0.02);
  EXPECT_NEAR(store[part].start().x(), 1.0, 0.02);
  EXPECT_EQ(store[wall].next, part);
  EXPECT_EQ(store[part].next, next);
  EXPECT_EQ(store[next].previous, part);
  EXPECT_TRUE(isNear(store, {1.5, 0.0}, part));
  store.merge(wall, part);
  EXPECT_FALSE(store[part].alive);
  EXPECT_NEAR(store[wall].length(), 2.0, 0.04);
  EXPECT_EQ(store[wall].next, next);
  EXPECT_TRUE(isNear(store, {1.5, 0.0}, wall));
}

TEST(SegmentStore, PrunesSegmentsThatManyMoreRaysCrossThanEndOn) {
  SegmentStore store{SegmentFitterOptions()};
  const int crossed = addWall(0.0, 2.0, store), kept = addWall(3.0, 5.0, store);
  for (SegmentCell& cell : store[crossed].evidence.row.cells()) cell.crossed = 100.0;
  EXPECT_EQ(store.prune(), 1u);
  EXPECT_FALSE(store[crossed].alive);
  EXPECT_TRUE(store[kept].alive);
}

}  // namespace
}  // namespace gaussmap::detail
