// SPDX-License-Identifier: BSD-3-Clause
#include "segments/free_space.h"

#include <gtest/gtest.h>

#include <cmath>

#include "segments/scan_makers.h"

namespace gaussmap::detail {
namespace {

LiveSegment liveWall(const Vector<2>& from, const Vector<2>& to) {
  LiveSegment segment;
  segment.alive = true;
  const Vector<2> axis = (to - from).normalized();
  segment.evidence.row = CellRow(from, axis, 0.1);
  for (double t = 0.01; t < (to - from).norm(); t += 0.02) segment.evidence.row.add(from + t * axis, 1.0);
  segment.view = {-axis.y(), axis.x()};
  refit(segment);
  return segment;
}

double crossed(const LiveSegment& segment) {
  double sum = 0.0;
  for (const SegmentCell& cell : segment.evidence.row.cells()) sum += cell.crossed;
  return sum;
}

/// Rays that pass through a segment, well off its ends, steeply, and end well behind it.
double crossedByBruteForce(const ScanBeams& beams, const LiveSegment& segment) {
  double sum = 0.0;
  for (std::size_t i = 0; i < beams.hits.size(); ++i) {
    if (!beams.scan.returned(i)) continue;
    const Vector<2> ray = (beams.hits[i] - beams.sensor()).normalized();
    const double sine = segment.line.normal().dot(ray),
                 range = segment.line.normal().dot(segment.line.center - beams.sensor()) / sine;
    const double t = segment.line.position(beams.sensor() + range * ray);
    sum += std::abs(sine) >= 0.2 && range > 0.0 && range + 0.2 <= beams.scan.ranges[i] && t >= segment.begin + 0.05 &&
           t <= segment.end - 0.05;
  }
  return sum;
}

TEST(CountCrossings, CountsAsABruteForceSearchDoes) {
  Random random(1);
  double all = 0.0;
  for (int trial = 0; trial < 60; ++trial) {
    const ScanBeams beams(test::look(test::room(-4.0, -3.0, 5.0, 4.0), 2.0 * random.uniform(), random.uniform(),
                                     7.0 * random.uniform(), 0.01, random, trial % 2 ? 180 : 360));
    std::deque<LiveSegment> segments;
    for (int k = 0; k < 10; ++k) {
      const Vector<2> from(8.0 * random.uniform() - 4.0, 6.0 * random.uniform() - 3.0);
      segments.push_back(liveWall(from, from + 2.0 * Vector<2>(random.normal(), random.normal())));
    }
    countCrossings(beams, 2.0, segments);
    for (const LiveSegment& segment : segments) {
      // A ray through the very border of a first or last cell may find no cell.
      EXPECT_NEAR(crossed(segment), 2.0 * crossedByBruteForce(beams, segment), 2.0);
      all += crossed(segment);
    }
  }
  EXPECT_GT(all, 1000.0);
}

TEST(Views, TellWhatWentThroughASegmentThatWasMadeLater) {
  Random random(2);
  const std::vector<Segment> walls = test::room(-4.0, -3.0, 4.0, 3.0);
  Views views;
  for (int i = 0; i < 5; ++i) views.add(test::look(walls, 0.01 + 0.02 * i, 0.01, 0.01, 0.0, random));
  std::deque<LiveSegment> segments = {liveWall({1.0, -0.5}, {1.0, 0.5}), liveWall({4.0, -0.5}, {4.0, 0.5})};
  views.countCrossings(segments);
  views.countCrossings(segments);  // counts again from zero, does not add
  // 5 scans of about 2 * atan(0.45) / 1 degree beams.
  EXPECT_NEAR(crossed(segments[0]), 5.0 * 48.0, 10.0);
  EXPECT_DOUBLE_EQ(crossed(segments[1]), 0.0);
}

TEST(Views, GrowWithThePlacesNotWithTheScans) {
  Random random(3);
  const LaserScan scan = test::look(test::room(-4.0, -3.0, 4.0, 3.0), 0.0, 0.0, 0.0, 0.0, random);
  Views views;
  views.add(scan);
  const std::size_t bytes = views.bytes();
  for (int i = 0; i < 100; ++i) views.add(scan);
  EXPECT_EQ(views.bytes(), bytes);
  LaserScan elsewhere = scan;
  elsewhere.pose.translation.x() += 1.0;
  views.add(elsewhere);
  EXPECT_GT(views.bytes(), bytes);
}

}  // namespace
}  // namespace gaussmap::detail
