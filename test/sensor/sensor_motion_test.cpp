// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/sensor_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/pi.h"

namespace gaussmap {
namespace {

using Eigen::Vector3d;

/// Scans of a room of 30 x 20 x 5 m about the origin, with a post of 1.2 m that moves along y at x = 4.
struct Room {
  int rings = 16, columns = 360;
  double share = 1.0;   // of the beams that return, chosen at random
  double noise = 0.02;  // [m]
  bool has_post = true;

  Scan scanFrom(const Vector3d& position, double post_y, unsigned seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> error(0.0, noise);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    Scan scan;
    for (int ring = 0; ring < rings; ++ring)
      for (int column = 0; column < columns; ++column) {
        const double elevation = (-20.0 + 35.0 * ring / (rings - 1)) * detail::kDegree;
        const double azimuth = 2.0 * detail::kPi * (column + 0.5) / columns;
        const Vector3d ray(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                           std::sin(elevation));
        const Vector3d half(15.0, 10.0, 2.5);
        double range = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis)
          range = std::min(range, (std::copysign(half[axis], ray[axis]) - position[axis]) / ray[axis]);
        if (has_post && ray.x() > 0.0) {
          const double at = (4.0 - position.x()) / ray.x();
          if (at > 0.0 && at < range && std::abs(position.y() + at * ray.y() - post_y) < 0.6) range = at;
        }
        const double measured = range + error(random);
        if (chance(random) < share) scan.points.push_back(measured * ray);
      }
    return scan;
  }

  /// Returns `count` scans from positions `step` [m] apart. `in_map`: the points are in the map frame, and all poses
  /// are the identity.
  MemoryScans scans(int count, const Vector3d& step, ScanFrame frame) const {
    MemoryScans scans(frame);
    for (int i = 0; i < count; ++i) {
      const Vector3d position = Vector3d(-5.0, 1.0, 0.3) + i * step;
      Scan scan = scanFrom(position, -6.0 + i, static_cast<unsigned>(i));
      if (frame == ScanFrame::Map)
        for (Vector3d& point : scan.points) point += position;
      else
        scan.pose.translation = step.isZero() ? position : Vector3d::Zero();
      scans.add(scan);
    }
    return scans;
  }
};

TEST(CompareViews, AgreesWithASensorThatStandsStill) {
  for (const double share : {1.0, 0.6})
    for (const int columns : {60, 360, 1800})
      for (const int count : {2, 3, 4, 12}) {
        Room room;
        room.share = share;
        room.columns = columns;
        const auto worst = detail::compareViews(room.scans(count, Vector3d::Zero(), ScanFrame::Sensor));
        ASSERT_TRUE(worst);
        EXPECT_FALSE(worst->moved()) << share << " " << columns << " " << count << ": " << worst->density << " "
                                     << worst->range;
      }
}

TEST(CompareViews, AgreesWithAStandingSensorWhosePointsAreInTheMapFrame) {
  MemoryScans scans(ScanFrame::Map);
  for (unsigned i = 0; i < 6; ++i) {
    Scan scan = Room().scanFrom({0, 0, 0}, -3.0 + i, i);
    for (Vector3d& point : scan.points) point += Vector3d(100, 50, 2);
    scan.pose.translation = {100, 50, 2};
    scans.add(scan);
  }
  const auto worst = detail::compareViews(scans);
  ASSERT_TRUE(worst);
  EXPECT_FALSE(worst->moved());
}

TEST(CompareViews, SeesThatTheSensorMovedWhenThePointsAreInTheMapFrame) {
  for (const int columns : {60, 360})
    for (const int count : {2, 3, 9}) {
      Room room;
      room.columns = columns;
      const auto worst = detail::compareViews(room.scans(count, Vector3d(8.0 / (count - 1), 0, 0), ScanFrame::Map));
      ASSERT_TRUE(worst);
      EXPECT_TRUE(worst->moved()) << columns << " " << count << ": " << worst->density << " " << worst->range;
      EXPECT_LT(worst->first, worst->second);
      EXPECT_LT(worst->second, std::size_t(count));
    }
}

TEST(CompareViews, SeesThatTheSensorMovedWhenThePosesAreMissing) {
  const auto worst = detail::compareViews(Room().scans(6, Vector3d(1.5, 0.5, 0), ScanFrame::Sensor));
  ASSERT_TRUE(worst);
  EXPECT_TRUE(worst->moved());
  EXPECT_GT(worst->density, worst->least_density);  // the same beams, at other ranges
}

TEST(CompareViews, IgnoresOneScanThatDiffersFromAllOthers) {
  MemoryScans scans;
  for (unsigned i = 0; i < 8; ++i) {
    Scan scan = Room().scanFrom({0, 0, 0}, -3.0 + i, i);
    if (i == 4)
      for (Vector3d& point : scan.points) point = 1.5 * point.normalized();  // a truck around the sensor
    scans.add(scan);
  }
  EXPECT_FALSE(detail::compareViews(scans)->moved());
}

TEST(CompareViews, HasNothingToCompareWithoutCommonDirectionsOrWithDifferentPositions) {
  MemoryScans scans;
  EXPECT_FALSE(detail::compareViews(scans));
  Scan ahead = Room().scanFrom({0, 0, 0}, 0.0, 1);
  scans.add(ahead);
  EXPECT_FALSE(detail::compareViews(scans));
  scans.add(Scan{{{std::numeric_limits<double>::quiet_NaN(), 0, 0}, {0, 0, 0}}, {}});
  EXPECT_FALSE(detail::compareViews(scans));  // the second one has no point
  ahead.pose.translation.x() = 0.01;
  scans.add(ahead);
  EXPECT_FALSE(detail::compareViews(scans));

  // A camera that turns on its tripod: different directions each time.
  MemoryScans turning(ScanFrame::Map);
  for (int i = 0; i < 4; ++i) {
    Scan view;
    for (const Vector3d& point : Room().scanFrom({0, 0, 0}, 0.0, 1).points)
      if (std::abs(std::remainder(std::atan2(point.y(), point.x()) - i * detail::kPi / 2.0, 2.0 * detail::kPi)) < 0.5)
        view.points.push_back(point);
    turning.add(view);
  }
  EXPECT_FALSE(detail::compareViews(turning));
}

}  // namespace
}  // namespace gaussmap
