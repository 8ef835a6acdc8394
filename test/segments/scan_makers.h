// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_map.h"

namespace gaussmap::test {

inline Segment wall(double x0, double y0, double x1, double y1) {
  Segment segment;
  segment.start = {x0, y0};
  segment.end = {x1, y1};
  return segment;
}

/// Returns the walls of a closed room with free space inside, counter-clockwise.
inline std::vector<Segment> room(double x0, double y0, double x1, double y1) {
  return {wall(x0, y0, x1, y0), wall(x1, y0, x1, y1), wall(x1, y1, x0, y1), wall(x0, y1, x0, y0)};
}

/// Returns the scan of a laser with one beam per degree. It has a full view except for the seam behind it, and sees
/// walls from either side.
inline LaserScan look(const std::vector<Segment>& walls, double x, double y, double heading, double noise,
                      Random& random, int beams = 360) {
  LaserScan scan;
  scan.pose.translation = {x, y};
  scan.pose.heading = heading;
  for (int i = 0; i < beams; ++i) {
    const double bearing = (i + 0.5 - 0.5 * beams) * std::acos(-1.0) / 180.0;
    const Vector<2> ray(std::cos(heading + bearing), std::sin(heading + bearing));
    double range = std::numeric_limits<double>::infinity();
    for (const Segment& wall : walls) {
      const Vector<2> along = wall.end - wall.start, to = wall.start - scan.pose.translation;
      const double across = ray.x() * along.y() - ray.y() * along.x();
      const double distance = (to.x() * along.y() - to.y() * along.x()) / across,
                   share = (to.x() * ray.y() - to.y() * ray.x()) / across;
      if (distance > 0.0 && share >= 0.0 && share <= 1.0 && distance < range) range = distance;
    }
    scan.bearings.push_back(bearing);
    scan.ranges.push_back(range + noise * random.normal());
  }
  return scan;
}

}  // namespace gaussmap::test
