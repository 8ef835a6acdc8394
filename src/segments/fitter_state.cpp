// SPDX-License-Identifier: BSD-3-Clause
#include "segments/fitter_state.h"

#include <algorithm>
#include <cmath>

namespace gaussmap::detail {

namespace {

constexpr double kMany = 2.0;         // rays through for one that ends on it
constexpr double kFewestRays = 10.0;  // through what is pruned

}  // namespace

int SegmentFitterState::create() {
  int id = static_cast<int>(segments.size());
  if (unused.empty()) {
    segments.emplace_back();
  } else {
    id = unused.back();
    unused.pop_back();
  }
  segments[id].alive = true;
  return id;
}

void SegmentFitterState::remove(int id) {
  detach(id, segments);
  index.erase(id);
  segments[id] = LiveSegment();
  unused.push_back(id);
}

int SegmentFitterState::split(int id, std::size_t cut, bool linked) {
  const int next = segments[id].next, previous = segments[id].previous;
  detach(id, segments);
  const LiveSegment whole = std::move(segments[id]);
  const int other = create();
  segments[id] = partOf(whole, 0, cut);
  segments[other] = partOf(whole, cut, whole.evidence.row.cells().size());
  if (previous != kNone) link(previous, id, segments);
  if (next != kNone) link(other, next, segments);
  if (linked) link(id, other, segments);
  enter(id);
  enter(other);
  return other;
}

void SegmentFitterState::merge(int into, int from) {
  int previous = segments[into].previous, next = segments[into].next;
  if (next == from || next == kNone) next = segments[from].next;
  if (previous == from || previous == kNone) previous = segments[from].previous;
  LiveSegment both = merged(segments[into], segments[from]);
  detach(into, segments);
  remove(from);
  segments[into] = std::move(both);
  if (next != kNone && next != into) link(into, next, segments);
  if (previous != kNone && previous != into) link(previous, into, segments);
  enter(into);
}

std::size_t SegmentFitterState::prune() {
  std::size_t pruned = 0;
  for (int id = 0; id < static_cast<int>(segments.size()); ++id) {
    if (!segments[id].alive) continue;
    double crossed = 0.0;
    for (const SegmentCell& cell : segments[id].evidence.row.cells()) crossed += cell.crossed;
    if (crossed < kFewestRays || crossed < kMany * segments[id].spread.beams()) continue;
    remove(id);
    ++pruned;
  }
  return pruned;
}

Strip SegmentFitterState::polygon(const LiveSegment& segment) const {
  return {segment.start() - options.growth * segment.line.direction, segment.line.direction,
          segment.length() + 2.0 * options.growth,
          std::max(options.min_half_width, 3.0 * std::sqrt(segment.line.across))};
}

SegmentGoals SegmentFitterState::inMap(SegmentGoals goals) const {
  goals.start += origin;
  goals.end += origin;
  return goals;
}

}  // namespace gaussmap::detail
