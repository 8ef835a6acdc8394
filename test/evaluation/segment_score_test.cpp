// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/segment_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kPi = 3.14159265358979323846;

Segment line(double x0, double y0, double x1, double y1) {
  Segment segment;
  segment.start = {x0, y0};
  segment.end = {x1, y1};
  return segment;
}

SegmentMap mapOf(const std::vector<Segment>& segments) {
  SegmentMap map;
  map.segments = segments;
  for (std::size_t i = 0; i < segments.size(); ++i) map.chains.push_back({i, i + 1, false});
  return map;
}

/// Beams straight ahead, along x from the origin.
LaserScan ahead(const std::vector<double>& ranges) {
  LaserScan scan;
  scan.ranges = ranges;
  scan.bearings.assign(ranges.size(), 0.0);
  return scan;
}

TEST(HoldOutScore, CountsEndsByTheirDistanceAndRaysByWhereTheyStop) {
  // A wall across the beams at x = 5.
  const SegmentMap map = mapOf({line(5, -1, 5, 1)});
  const HoldOutScore score = scoreHoldOut(map, {ahead({5.0, 5.04, 5.08, 5.16, 5.3, 4.0})});
  EXPECT_EQ(score.beams, 6u);
  EXPECT_DOUBLE_EQ(score.within_5cm, 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(score.within_10cm, 3.0 / 6.0);
  EXPECT_NEAR(score.rms, std::sqrt((0.0016 + 0.0064 + 0.0256) / 4.0), 1e-12);
  EXPECT_DOUBLE_EQ(score.predicted_10cm, 3.0 / 6.0);
  EXPECT_DOUBLE_EQ(score.blocked_early, 1.0 / 6.0);  // 5.3; the beam of 4 m is not blocked, it ends too early
}

TEST(HoldOutScore, StopsRaysFromEitherSideAtTheFirstSegment) {
  const LaserScan scan = ahead({5.0});
  EXPECT_EQ(scoreHoldOut(mapOf({line(5, -1, 5, 1)}), {scan}).predicted_10cm, 1.0);
  EXPECT_EQ(scoreHoldOut(mapOf({line(5, 1, 5, -1)}), {scan}).predicted_10cm, 1.0);
  const HoldOutScore behind = scoreHoldOut(mapOf({line(5, -1, 5, 1), line(2, -1, 2, 1)}), {scan});
  EXPECT_EQ(behind.predicted_10cm, 0.0);
  EXPECT_EQ(behind.blocked_early, 1.0);
  EXPECT_EQ(behind.within_5cm, 1.0);
  EXPECT_EQ(scoreHoldOut(mapOf({line(-5, -1, -5, 1)}), {scan}).blocked_early, 0.0);
}

TEST(HoldOutScore, IsZeroWithoutBeamsOrSegments) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  LaserScan lost = ahead({5.0});
  lost.pose.translation.x() = nan;
  for (const std::vector<LaserScan>& scans :
       {std::vector<LaserScan>(), {LaserScan()}, {ahead({0.0, nan, infinity, -1.0, 80.0})}, {lost}}) {
    const HoldOutScore score = scoreHoldOut(mapOf({line(5, -1, 5, 1)}), scans);
    EXPECT_EQ(score.beams, 0u);
    EXPECT_EQ(score.within_10cm + score.rms + score.predicted_10cm + score.blocked_early, 0.0);
  }
  const HoldOutScore none = scoreHoldOut({}, {ahead({5.0})});
  EXPECT_EQ(none.beams, 1u);
  EXPECT_EQ(none.within_10cm + none.rms + none.predicted_10cm + none.blocked_early, 0.0);
  LaserScan odd = ahead({5.0});
  odd.bearings.clear();
  EXPECT_THROW(scoreHoldOut({}, {odd}), std::invalid_argument);
}

TEST(HoldOutScore, IsExactFarFromTheOrigin) {
  LaserScan scan = ahead({5.0, 5.04, 5.3});
  scan.pose.translation = {1e7, -1e7};
  const HoldOutScore score = scoreHoldOut(mapOf({line(1e7 + 5, -1e7 - 1, 1e7 + 5, -1e7 + 1)}), {scan});
  EXPECT_DOUBLE_EQ(score.within_5cm, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(score.predicted_10cm, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(score.blocked_early, 1.0 / 3.0);
}

/// Range at which a ray meets a segment, infinity if it does not: Cramer's rule.
double meet(const Segment& segment, const Vector<2>& origin, const Vector<2>& way) {
  const Vector<2> along = segment.end - segment.start, offset = segment.start - origin;
  const double determinant = along.x() * way.y() - along.y() * way.x();
  const double range = (along.x() * offset.y() - along.y() * offset.x()) / determinant;
  const double part = (way.x() * offset.y() - way.y() * offset.x()) / determinant;
  return range > 0.0 && part >= 0.0 && part <= 1.0 ? range : std::numeric_limits<double>::infinity();
}

TEST(HoldOutScore, IsWhatABruteForceSearchFinds) {
  Random random(11);
  for (int round = 0; round < 20; ++round) {
    std::vector<Segment> segments;
    for (int i = 0; i < 150; ++i) {
      const double x = 20 * random.uniform(), y = 20 * random.uniform();
      segments.push_back(line(x, y, x + random.normal(), y + (i % 10 == 0 ? 0.0 : random.normal())));
    }
    segments.push_back(line(1, 1, 1, 1));  // a point
    std::vector<LaserScan> scans(5);
    double beams = 0, near = 0, close = 0, predicted = 0, blocked = 0, squares = 0, not_far = 0;
    for (LaserScan& scan : scans) {
      scan.pose.translation = {20 * random.uniform(), 20 * random.uniform()};
      scan.pose.heading = 6 * random.uniform();
      for (int i = 0; i < 100; ++i) {
        const double bearing = 2 * kPi * (random.uniform() - 0.5);
        const Vector<2> way(std::cos(scan.pose.heading + bearing), std::sin(scan.pose.heading + bearing));
        double first = std::numeric_limits<double>::infinity(), distance = first;
        for (const Segment& segment : segments) first = std::min(first, meet(segment, scan.pose.translation, way));
        const double range = std::isfinite(first) ? std::abs(first + 0.15 * random.normal()) : 3.0;
        scan.bearings.push_back(bearing);
        scan.ranges.push_back(range);
        for (const Segment& segment : segments)
          distance = std::min(distance, segment.distance(scan.pose.translation + range * way));
        ++beams;
        near += distance <= 0.05;
        close += distance <= 0.10;
        if (distance <= 0.20) {
          ++not_far;
          squares += distance * distance;
        }
        predicted += std::abs(first - range) <= 0.10;
        blocked += first < range - 0.20;
      }
    }
    const HoldOutScore score = scoreHoldOut(mapOf(segments), scans);
    EXPECT_EQ(score.beams, static_cast<std::size_t>(beams));
    EXPECT_NEAR(score.within_5cm, near / beams, 1e-12);
    EXPECT_NEAR(score.within_10cm, close / beams, 1e-12);
    EXPECT_NEAR(score.rms, std::sqrt(squares / not_far), 1e-9);
    EXPECT_NEAR(score.predicted_10cm, predicted / beams, 1e-12);
    EXPECT_NEAR(score.blocked_early, blocked / beams, 1e-12);
    EXPECT_GT(predicted, 0.0);
    EXPECT_GT(blocked, 0.0);
  }
}

}  // namespace
}  // namespace gaussmap
