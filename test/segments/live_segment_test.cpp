// SPDX-License-Identifier: BSD-3-Clause
#include "segments/live_segment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gaussmap::detail {
namespace {

LiveSegment segmentThrough(const std::vector<Vector<2>>& points, const Vector<2>& axis) {
  LiveSegment segment;
  segment.alive = true;
  segment.evidence.row = CellRow(points.front(), axis, 0.1);
  for (const Vector<2>& point : points) segment.evidence.row.add(point, 1.0);
  segment.view = {-axis.y(), axis.x()};
  refit(segment);
  return segment;
}

std::vector<Vector<2>> along(const Vector<2>& from, const Vector<2>& to, int count) {
  std::vector<Vector<2>> points;
  for (int i = 0; i < count; ++i) points.push_back(from + (to - from) * (double(i) / (count - 1)));
  return points;
}

TEST(BestBreak, IsThatOfABruteForceSearch) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    CellRow row({0.0, 0.0}, {1.0, 0.0}, 0.1);
    for (int i = 0; i < 60; ++i) row.add({2.0 * random.uniform(), 0.3 * random.normal()}, 1.0);
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    for (std::size_t cut = 1; cut < row.cells().size(); ++cut) {
      LineMoments side[2];
      for (std::size_t i = 0; i < row.cells().size(); ++i)
        if (const LineMoments& hits = row.cells()[i].hits; hits.n > 0.0)
          side[i >= cut] += cellWeight(hits.n) / hits.n * hits;
      const double error = squaredError(side[0]) + squaredError(side[1]);
      if (error < least - 1e-12) {
        least = error;
        best = cut;
      }
    }
    EXPECT_EQ(bestBreak(row), best);
  }
}

TEST(BestBreak, IsAtTheCorner) {
  std::vector<Vector<2>> points = along({0.0, 0.0}, {1.2, 0.0}, 100);
  for (const Vector<2>& point : along({1.2, 0.0}, {2.4, 0.5}, 100)) points.push_back(point);
  const LiveSegment segment = segmentThrough(points, {1.0, 0.0});
  EXPECT_NEAR(static_cast<double>(bestBreak(segment.evidence.row)), 12.0, 1.0);
}

TEST(BestBreak, ThereIsNoneInOneCell) {
  CellRow row({0.0, 0.0}, {1.0, 0.0}, 0.1);
  EXPECT_EQ(bestBreak(row), 0u);
  row.add({0.05, 0.0}, 3.0);
  EXPECT_EQ(bestBreak(row), 0u);
}

TEST(LiveSegment, FreeSpaceIsOnTheLeftWhateverTheOrderOfItsEvidence) {
  LiveSegment segment = segmentThrough(along({0.0, 0.0}, {2.0, 0.0}, 50), {1.0, 0.0});
  segment.view = {0.0, -3.0};
  refit(segment);
  EXPECT_NEAR((segment.line.direction - Vector<2>(-1.0, 0.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((segment.start() - Vector<2>(2.0, 0.0)).norm(), 0.0, 0.02);
}

TEST(LiveSegment, PartsAndMergesKeepTheEvidence) {
  const LiveSegment whole = segmentThrough(along({0.0, 0.0}, {2.0, 1.0}, 200), Vector<2>(2.0, 1.0).normalized());
  const std::size_t cells = whole.evidence.row.cells().size();
  const LiveSegment first = partOf(whole, 0, 9), second = partOf(whole, 9, cells);
  EXPECT_NEAR(first.total.n + second.total.n, 200.0, 1e-9);
  EXPECT_NEAR((first.finish() - second.start()).norm(), 0.0, 0.02);
  const LiveSegment again = merged(second, first);
  EXPECT_NEAR((again.start() - whole.start()).norm(), 0.0, 1e-6);
  EXPECT_NEAR((again.finish() - whole.finish()).norm(), 0.0, 1e-6);
  EXPECT_NEAR(goalsTogether(first, second).length, whole.length(), 1e-6);
  EXPECT_NEAR(goalsOfPart(whole, 0, 9).length, first.length(), 1e-9);
  EXPECT_NEAR(goalsOfPart(whole, 0, 9).misfit, first.goals().misfit, 1e-9);
}

TEST(LiveSegment, MergingAShortOneAcrossDoesNotFoldALongOne) {
  const LiveSegment wall = segmentThrough(along({0.0, 0.0}, {3.0, 0.0}, 300), {1.0, 0.0});
  const LiveSegment end = segmentThrough(along({3.0, 0.0}, {3.0, 0.1}, 5), {0.0, 1.0});
  for (const LiveSegment& both : {merged(wall, end), merged(end, wall)})
    EXPECT_GE(both.evidence.row.cells().size(), 30u);
}

TEST(LiveSegment, LinksAreMutual) {
  std::deque<LiveSegment> segments(4);
  link(0, 1, segments);
  link(1, 2, segments);
  link(3, 2, segments);  // takes the place of 1
  EXPECT_EQ(segments[1].next, kNone);
  EXPECT_EQ(segments[2].previous, 3);
  link(0, 3, segments);  // 1 is left alone
  EXPECT_EQ(segments[1].previous, kNone);
  detach(3, segments);
  for (const LiveSegment& segment : segments) {
    EXPECT_EQ(segment.next, kNone);
    EXPECT_EQ(segment.previous, kNone);
  }
}

}  // namespace
}  // namespace gaussmap::detail
