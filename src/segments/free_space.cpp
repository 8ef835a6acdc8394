// SPDX-License-Identifier: BSD-3-Clause
#include "segments/free_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/pi.h"

namespace gaussmap::detail {
namespace {

constexpr double kBehind = 0.2;    // a ray crosses a segment if it ends at least this far behind it [m]
constexpr double kGrazing = 0.2;   // minimum sine of the angle between ray and segment: below, a crossing is uncertain
constexpr double kEdge = 0.05;     // length at both ends of a segment where a crossing is uncertain [m]
constexpr double kPlace = 0.5;     // Views keeps one scan per square of this side [m] ...
constexpr double kHeading = 0.25;  // ... and per interval of heading of this size [rad]

}  // namespace

void countCrossings(const ScanBeams& beams, double weight, std::deque<LiveSegment>& segments) {
  const LaserScan& scan = beams.scan;
  std::vector<double> bearings;  // of beams that returned
  std::vector<std::size_t> numbers;
  double farthest = 0.0;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    if (scan.returned(i)) {
      bearings.push_back(scan.bearings[i]);
      numbers.push_back(i);
      farthest = std::max(farthest, scan.ranges[i]);
    }
  if (bearings.empty()) return;
  const Vector<2>& sensor = beams.sensor();
  const double c = std::cos(scan.pose.heading), s = std::sin(scan.pose.heading);
  for (LiveSegment& segment : segments) {
    const double half = 0.5 * segment.length() - kEdge, reach = farthest + half;
    if (!segment.alive || half <= 0.0) continue;
    const Vector<2>& along = segment.line.direction;
    const Vector<2> middle = segment.line.center + 0.5 * (segment.begin + segment.end) * along - sensor;
    if (middle.squaredNorm() > reach * reach) continue;
    // Tests the beams between the bearings of its ends. The bearings of the scan may differ by a full turn.
    const Vector<2> a = middle - half * along, b = middle + half * along;
    const double first = std::atan2(c * a.y() - s * a.x(), c * a.x() + s * a.y()),
                 turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    const double low = std::min(first, first + turn), high = std::max(first, first + turn);
    const Vector<2> normal = segment.line.normal();
    const double distance = normal.dot(middle);
    CellRow& row = segment.evidence.row;
    for (const double full : {-2.0 * kPi, 0.0, 2.0 * kPi}) {
      if (high + full < bearings.front() || low + full > bearings.back()) continue;
      auto k =
          static_cast<std::size_t>(std::lower_bound(bearings.begin(), bearings.end(), low + full) - bearings.begin());
      for (; k < bearings.size() && bearings[k] <= high + full; ++k) {
        const double measured = scan.ranges[numbers[k]];
        const Vector<2> ray = (beams.hits[numbers[k]] - sensor) / measured;
        const double sine = normal.dot(ray);
        if (std::abs(sine) < kGrazing) continue;
        const double range = distance / sine;
        if (range <= 0.0 || measured < range + kBehind) continue;
        const int cell = row.index(sensor + range * ray) - row.first();
        if (cell < 0 || cell >= static_cast<int>(row.cells().size())) continue;
        row.cells()[static_cast<std::size_t>(cell)].crossed += weight;
      }
    }
  }
}

void Views::add(const LaserScan& scan) {
  const Vector<2>& sensor = scan.pose.translation;
  const double heading = std::remainder(scan.pose.heading, 2.0 * kPi);
  const auto lattice = [](double value, double step) { return static_cast<std::int64_t>(std::floor(value / step)); };
  View& view = views_[{lattice(sensor.x(), kPlace), lattice(sensor.y(), kPlace), lattice(heading, kHeading)}];
  view.scans += 1.0;
  if (view.scans > 1.0) return;
  view.sensor = sensor;
  view.heading = heading;
  std::vector<float> bearings(scan.bearings.begin(), scan.bearings.end());
  if (!bearings_ || bearings != *bearings_) bearings_ = std::make_shared<const std::vector<float>>(std::move(bearings));
  view.bearings = bearings_;
  view.ranges.resize(scan.ranges.size(), 0.0f);
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    if (scan.returned(i)) view.ranges[i] = static_cast<float>(scan.ranges[i]);
}

void Views::countCrossings(std::deque<LiveSegment>& segments) const {
  for (LiveSegment& segment : segments)
    for (SegmentCell& cell : segment.evidence.row.cells()) cell.crossed = 0.0;
  for (const auto& entry : views_) {
    const View& view = entry.second;
    LaserScan scan;
    scan.pose.translation = view.sensor;
    scan.pose.heading = view.heading;
    scan.bearings.assign(view.bearings->begin(), view.bearings->end());
    scan.ranges.assign(view.ranges.begin(), view.ranges.end());
    scan.max_range = std::numeric_limits<double>::infinity();
    detail::countCrossings(ScanBeams(scan), view.scans, segments);
  }
}

std::size_t Views::bytes() const {
  std::size_t sum = 0;
  const std::vector<float>* last = nullptr;
  for (const auto& entry : views_) {
    constexpr std::size_t kNode = 32;  // bytes of a node of std::map, about
    sum += sizeof(entry) + kNode + entry.second.ranges.capacity() * sizeof(float);
    if (entry.second.bearings.get() != last) sum += entry.second.bearings->capacity() * sizeof(float);
    last = entry.second.bearings.get();
  }
  return sum;
}

}  // namespace gaussmap::detail
