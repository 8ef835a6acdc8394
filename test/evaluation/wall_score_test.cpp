// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/wall_score.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

Segment line(double x0, double y0, double x1, double y1) {
  Segment segment;
  segment.start = {x0, y0};
  segment.end = {x1, y1};
  segment.covariance = Matrix<2>::Identity();
  return segment;
}

SegmentMap mapOf(const std::vector<Segment>& segments) {
  SegmentMap map;
  map.segments = segments;
  for (std::size_t i = 0; i < segments.size(); ++i) map.chains.push_back({i, i + 1, false});
  return map;
}

/// A room of 4 m x 3 m seen from within: free space on the left.
std::vector<Segment> room() {
  return {line(0, 0, 4, 0), line(4, 0, 4, 3), line(4, 3, 0, 3), line(0, 3, 0, 0)};
}

TEST(WallScore, IsPerfectForTheWallsThemselves) {
  const WallScore score = scoreWalls(mapOf(room()), room());
  EXPECT_DOUBLE_EQ(score.recall, 1.0);
  EXPECT_DOUBLE_EQ(score.precision, 1.0);
  EXPECT_EQ(score.matched, 4u);
  EXPECT_NEAR(score.offset_rms, 0.0, 1e-12);
  EXPECT_NEAR(score.angle_rms, 0.0, 1e-12);
  EXPECT_NEAR(score.normalised_error, 0.0, 1e-12);
  EXPECT_EQ(score.corners, 4u);
  EXPECT_NEAR(score.corner_median, 0.0, 1e-12);
}

TEST(WallScore, SharesAreOfTheLength) {
  // Half of the 4 m wall, and 2 m in the middle of the room.
  const WallScore score = scoreWalls(mapOf({line(0, 0, 2, 0), line(1, 1.5, 3, 1.5)}), room());
  EXPECT_NEAR(score.recall, (2.0 + 0.1) / 14.0, 0.01 / 14.0 * 2);  // the tolerance reaches 5 cm round either end
  EXPECT_NEAR(score.precision, 0.5, 1e-12);
}

TEST(WallScore, MeasuresOffsetAndAngleAgainstTheWallThatLooksTheSameWay) {
  // A wall of 12 cm whose two faces look up and down.
  const std::vector<Segment> walls = {line(4, 0, 0, 0), line(0, 0.12, 4, 0.12)};
  const WallScore up = scoreWalls(mapOf({line(1, 0.13, 3, 0.13)}), walls);
  EXPECT_EQ(up.matched, 1u);
  EXPECT_NEAR(up.offset_rms, 0.01, 1e-12);
  EXPECT_NEAR(up.angle_rms, 0.0, 1e-12);
  EXPECT_EQ(scoreWalls(mapOf({line(3, 0.13, 1, 0.13)}), walls).matched, 0u);  // looks down, but is no lower face
  const double angle = 0.02;
  const WallScore turned = scoreWalls(
      mapOf({line(2 - std::cos(angle), 0.12 - std::sin(angle), 2 + std::cos(angle), 0.12 + std::sin(angle))}), walls);
  EXPECT_NEAR(turned.offset_rms, 0.0, 1e-12);
  EXPECT_NEAR(turned.angle_rms, angle, 1e-12);
}

TEST(WallScore, WeighsErrorsByLength) {
  const WallScore score = scoreWalls(mapOf({line(0, 0.03, 3, 0.03), line(3, 0.01, 4, 0.01)}), {line(0, 0, 4, 0)});
  EXPECT_NEAR(score.offset_rms, std::sqrt((3 * 0.0009 + 1 * 0.0001) / 4), 1e-12);
}

TEST(WallScore, LeavesShortWallsToRecallOnly) {
  const std::vector<Segment> walls = {line(0, 0, 0.3, 0)};
  const WallScore score = scoreWalls(mapOf({line(0, 0.01, 0.3, 0.01)}), walls);
  EXPECT_EQ(score.recall, 1.0);
  EXPECT_EQ(score.matched, 0u);
  WallScoreOptions options;
  options.shortest = 0.0;
  EXPECT_EQ(scoreWalls(mapOf({line(0, 0.01, 0.3, 0.01)}), walls, options).matched, 1u);
}

TEST(WallScore, CornersAreWhereWallsTurn) {
  SegmentMap map = mapOf(room());
  for (Segment& segment : map.segments) {
    segment.start.x() += 0.01;
    segment.end.x() += 0.01;
  }
  EXPECT_NEAR(scoreWalls(map, room()).corner_median, 0.01, 1e-12);
  // Two pieces of one wall make no corner.
  EXPECT_EQ(scoreWalls(map, {line(0, 0, 2, 0), line(2, 0, 4, 0)}).corners, 0u);
}

TEST(WallScore, NormalisedErrorIsTwoForCovariancesThatAreRight) {
  Random random(3);
  Matrix<2> covariance;
  covariance << 1e-4, 2e-5, 2e-5, 5e-5;
  const Matrix<2> factor = covariance.llt().matrixL();
  SegmentMap map;
  std::vector<Segment> walls;
  for (int i = 0; i < 4000; ++i) {
    const Vector<2> middle(10.0 * i, 0.0), error = factor * Vector<2>(random.normal(), random.normal());
    const Vector<2> along(std::cos(error.y()), std::sin(error.y())), centre = middle + Vector<2>(0.0, error.x());
    walls.push_back(line(middle.x() - 2, 0, middle.x() + 2, 0));
    Segment segment =
        line(centre.x() - along.x(), centre.y() - along.y(), centre.x() + along.x(), centre.y() + along.y());
    segment.covariance = covariance;
    map.segments.push_back(segment);
  }
  map.chains = {{0, map.segments.size(), false}};
  const WallScore score = scoreWalls(map, walls);
  EXPECT_EQ(score.matched, 4000u);
  EXPECT_NEAR(score.normalised_error, 2.0, 0.1);
  EXPECT_NEAR(score.offset_rms, 0.01, 0.0005);
}

TEST(WallScore, KnowsWhatNothingIsWorth) {
  const WallScore nothing = scoreWalls({}, room());
  EXPECT_EQ(nothing.recall, 0.0);
  EXPECT_EQ(nothing.precision, 1.0);
  EXPECT_TRUE(std::isinf(nothing.corner_median));
  const WallScore no_walls = scoreWalls(mapOf(room()), {});
  EXPECT_EQ(no_walls.recall, 1.0);
  EXPECT_EQ(no_walls.precision, 0.0);
  EXPECT_EQ(no_walls.matched + no_walls.corners, 0u);
}

TEST(WallScore, RefusesWhatIsNoNumber) {
  SegmentMap map = mapOf(room());
  map.segments[0].start.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(scoreWalls(map, room()), std::invalid_argument);
  for (double WallScoreOptions::*option : {&WallScoreOptions::tolerance, &WallScoreOptions::spacing}) {
    WallScoreOptions options;
    options.*option = 0.0;
    EXPECT_THROW(scoreWalls({}, room(), options), std::invalid_argument);
  }
  WallScoreOptions options;
  options.tolerance = -1e-9;
  try {
    scoreWalls({}, room(), options);
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "tolerance = -1e-09: must be positive");
  }
}

}  // namespace
}  // namespace gaussmap
