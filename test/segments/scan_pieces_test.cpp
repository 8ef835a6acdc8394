// SPDX-License-Identifier: BSD-3-Clause
#include "segments/scan_pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "segments/scan_makers.h"

namespace gaussmap::detail {
namespace {

TEST(FindRuns, EndAtMissingBeamsAndJumps) {
  LaserScan scan;
  for (int i = 0; i < 10; ++i) {
    scan.bearings.push_back(0.01 * i);
    scan.ranges.push_back(i < 7 ? 2.0 : 4.0);
  }
  scan.ranges[3] = std::numeric_limits<double>::infinity();
  const std::vector<BeamRun> runs = findRuns(ScanBeams(scan), 0.5);
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].last, 3u);
  EXPECT_EQ(runs[1].first, 4u);
  EXPECT_EQ(runs[1].last, 7u);
  EXPECT_EQ(runs[2].last, 10u);
}

TEST(FindRuns, EndWhereAScanLeavesBeamsOut) {
  LaserScan scan;
  for (const double bearing : {0.0, 0.01, 0.02, 0.04, 0.05}) {
    scan.bearings.push_back(bearing);
    scan.ranges.push_back(2.0);
  }
  EXPECT_EQ(findRuns(ScanBeams(scan), 0.5).size(), 2u);
}

TEST(FindRuns, ThereAreNoneWithoutReturns) {
  LaserScan scan;
  EXPECT_TRUE(findRuns(ScanBeams(scan), 0.5).empty());
  scan.bearings = {0.0, 0.1, 0.2};
  scan.ranges = {0.0, std::nan(""), 80.0};
  EXPECT_TRUE(findRuns(ScanBeams(scan), 0.5).empty());
}

TEST(StraightPieces, LieAlongTheWallsWithTheSensorOnTheLeft) {
  Random random(1);
  const std::vector<Segment> walls = test::room(-2.0, -1.5, 3.0, 2.0);
  const ScanBeams beams(test::look(walls, 0.3, 0.2, 0.4, 0.01, random));
  const std::vector<BeamRun> runs = findRuns(beams, 0.5);
  const std::vector<Vector<2>> pieces = straightPieces(runs, beams.hits, 0.06);
  std::size_t known = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].isZero(0.0)) continue;
    const Segment* nearest = &walls[0];
    for (const Segment& wall : walls)
      if (wall.distance(beams.hits[i]) < nearest->distance(beams.hits[i])) nearest = &wall;
    double corner = 1e9;
    for (const Segment& wall : walls) corner = std::min(corner, (wall.start - beams.hits[i]).norm());
    if (corner < 0.15) continue;
    ++known;
    EXPECT_GT(pieces[i].normalized().dot(nearest->direction()), 0.97);
  }
  EXPECT_GT(known, 320u);
}

TEST(StraightPieces, AreNotKnownOfAFewBeams) {
  const std::vector<Vector<2>> hits = {{1.0, 0.0}, {1.0, 0.02}, {1.0, 0.04}, {1.0, 0.05}};
  for (const Vector<2>& piece : straightPieces({{0, 2}, {2, 4}}, hits, 0.06)) EXPECT_TRUE(piece.isZero(0.0));
  for (const Vector<2>& piece : straightPieces({{0, 4}}, hits, 0.06)) EXPECT_TRUE(piece.isZero(0.0));
}

}  // namespace
}  // namespace gaussmap::detail
