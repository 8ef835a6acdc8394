// SPDX-License-Identifier: BSD-3-Clause
#include "segments/working_set.h"

#include <algorithm>
#include <cmath>

namespace gaussmap::detail {
namespace {

constexpr double kLinkDistance = 0.15;  // maximum distance of ends that are linked although no scan linked them [m]
constexpr double kCornerSine = 0.7;     // minimum sine of the angle between neighbours at a corner
constexpr double kCornerGap = 0.2;      // maximum distance between the ends at a corner [m]

}  // namespace

WorkingSet::WorkingSet(const std::deque<LiveSegment>& given, const SegmentFitterOptions& options)
    : originals(given), cell_size(options.cell), gap(options.gap), segments(given) {
  double observations = 0.0;
  for (std::size_t id = 0; id < segments.size(); ++id) {
    LiveSegment& segment = segments[id];
    segment.evidence.particles = {};  // the rows contain everything that is needed
    if (!segment.alive) continue;
    // Scales the moments of a limited number of particles to the number of all observations.
    const double scale =
        options.policy == EvidencePolicy::ParticleSets ? segment.spread.beams() / segment.total.n : 1.0;
    segment.total = scale * segment.total;
    for (SegmentCell& cell : segment.evidence.row.cells()) {
      if (cell.hits.n <= 0.0) continue;
      cell.hits = scale * cell.hits;
      atoms.push_back({cell.hits, static_cast<int>(id), cell.hits.n / segment.total.n});
      observations += cell.hits.n;
    }
  }
  const double average = atoms.empty() ? 0.0 : observations / static_cast<double>(atoms.size());
  const SegmentOptimisationOptions& costs = options.optimisation;
  score = {costs.tolerance, average * costs.segment_cost, average * costs.cell_cost, average * costs.hole_cost,
           costs.crossing_cost};
}

bool WorkingSet::closesCorner(int id) const {
  const LiveSegment& segment = segments[id];
  if (segment.next == kNone || segment.previous == kNone || segment.degenerate()) return false;
  const auto corner = [&](const LiveSegment& other, const Vector<2>& own_end, const Vector<2>& other_end) {
    const Vector<2>&u = segment.line.direction, &v = other.line.direction;
    return std::abs(u.x() * v.y() - u.y() * v.x()) > kCornerSine && (own_end - other_end).norm() < kCornerGap &&
           other.length() > segment.length();
  };
  const LiveSegment &next = segments[segment.next], &previous = segments[segment.previous];
  return corner(next, segment.finish(), next.start()) && corner(previous, segment.start(), previous.finish());
}

void WorkingSet::linkNear() {
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const int id = static_cast<int>(i), next = segments[id].next;
    if (next != kNone && (segments[next].start() - segments[id].finish()).norm() > gap) unlinkNext(id, segments);
  }
  struct Pair {
    double distance;
    int from, to;
  };
  std::vector<Pair> pairs;
  enterAll(kLinkDistance);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const int from = static_cast<int>(i);
    const LiveSegment& segment = segments[from];
    if (!segment.alive || segment.next != kNone) continue;
    for (const int to : index.near(segment.finish())) {
      const double distance = (segments[to].start() - segment.finish()).norm();
      if (to != from && segments[to].previous == kNone && distance < kLinkDistance)
        pairs.push_back({distance, from, to});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  for (const Pair& pair : pairs)
    if (segments[pair.from].next == kNone && segments[pair.to].previous == kNone) link(pair.from, pair.to, segments);
}

std::deque<LiveSegment> WorkingSet::result() {
  linkNear();
  std::vector<int> numbers(segments.size(), kNone);
  std::deque<LiveSegment> alive;
  for (std::size_t id = 0; id < segments.size(); ++id)
    if (segments[id].alive) {
      numbers[id] = static_cast<int>(alive.size());
      alive.push_back(std::move(segments[id]));
    }
  for (LiveSegment& segment : alive) {
    if (segment.next != kNone) segment.next = numbers[segment.next];
    if (segment.previous != kNone) segment.previous = numbers[segment.previous];
  }
  return alive;
}

void WorkingSet::enterAll(double reach) {
  index = SegmentIndex();
  for (std::size_t id = 0; id < segments.size(); ++id)
    if (segments[id].alive) index.update(static_cast<int>(id), strip(segments[id], reach));
}

Strip WorkingSet::strip(const LiveSegment& segment, double reach) const {
  return {segment.start() - reach * segment.line.direction, segment.line.direction, segment.length() + 2.0 * reach,
          score.tolerance};
}

void WorkingSet::remove(int id) {
  detach(id, segments);
  segments[id] = LiveSegment();
}

}  // namespace gaussmap::detail
