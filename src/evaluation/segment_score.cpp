// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/segment_score.h"

#include <stdexcept>
#include <string>

#include "evaluation/segment_tree.h"

namespace gaussmap::detail {
namespace {

constexpr double kNear = 0.05, kClose = 0.10, kFar = 0.20;  // [m]

}  // namespace

HoldOutScore scoreHoldOut(const SegmentMap& map, const std::vector<LaserScan>& scans) {
  const SegmentTree tree(map.segments);
  std::size_t beams = 0, near = 0, close = 0, not_far = 0, predicted = 0, blocked = 0;
  double squares = 0.0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const LaserScan& scan = scans[i];
    if (scan.bearings.size() != scan.ranges.size())
      throw std::invalid_argument("scan " + std::to_string(i) + " has " + std::to_string(scan.bearings.size()) +
                                  " bearings and " + std::to_string(scan.ranges.size()) + " ranges");
    for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
      if (!scan.returned(beam) || !scan.hit(beam).allFinite()) continue;
      ++beams;
      const double distance = tree.distance(scan.hit(beam));
      near += distance <= kNear;
      close += distance <= kClose;
      if (distance <= kFar) {
        ++not_far;
        squares += distance * distance;
      }
      const auto first = tree.intersect(scan.pose.translation, scan.pose.heading + scan.bearings[beam]);
      if (!first) continue;
      predicted += std::abs(first->range - scan.ranges[beam]) <= kClose;
      blocked += first->range < scan.ranges[beam] - kFar;
    }
  }
  HoldOutScore score;
  score.beams = beams;
  if (beams == 0) return score;
  const auto share = [beams](std::size_t part) { return static_cast<double>(part) / static_cast<double>(beams); };
  score.within_5cm = share(near);
  score.within_10cm = share(close);
  score.rms = not_far > 0 ? std::sqrt(squares / static_cast<double>(not_far)) : 0.0;
  score.predicted_10cm = share(predicted);
  score.blocked_early = share(blocked);
  return score;
}

}  // namespace gaussmap::detail
