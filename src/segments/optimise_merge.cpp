// SPDX-License-Identifier: BSD-3-Clause
#include "segments/optimise_merge.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace gaussmap::detail {
namespace {

constexpr double kMergeCosine = 0.95;  // minimum cosine of the angle between two segments
constexpr double kMergeGap = 0.3;      // maximum distance between them [m]

/// Merges a segment with the neighbour that increases the score most. Returns false if no neighbour increases it.
bool mergeBest(int id, WorkingSet& set) {
  std::deque<LiveSegment>& segments = set.segments;
  const LiveSegment& segment = segments[id];
  const double own = set.score.scoreOf(segment);
  double most = 1e-9 * set.score.segment_cost;
  int partner = kNone;
  LiveSegment best;
  std::vector<int> seen;
  for (const Vector<2>& place : {segment.start(), segment.line.center, segment.finish()})
    for (const int other : set.index.near(place)) {
      const LiveSegment& near = segments[other];
      if (other == id || near.line.direction.dot(segment.line.direction) < kMergeCosine ||
          near.squaredDistance(place) > kMergeGap * kMergeGap ||
          std::find(seen.begin(), seen.end(), other) != seen.end())
        continue;
      seen.push_back(other);
      LiveSegment both = merged(segment, near);
      const double gain = set.score.scoreOf(both) - own - set.score.scoreOf(near);
      if (gain > most) {
        most = gain;
        partner = other;
        best = std::move(both);
      }
    }
  if (partner == kNone) return false;
  int next = segment.next, previous = segment.previous;
  if (next == partner || next == kNone) next = segments[partner].next;
  if (previous == partner || previous == kNone) previous = segments[partner].previous;
  set.index.erase(partner);
  set.remove(partner);
  detach(id, segments);
  segments[id] = std::move(best);
  if (next != kNone && next != id && next != partner) link(id, next, segments);
  if (previous != kNone && previous != id && previous != partner) link(previous, id, segments);
  set.index.update(id, set.strip(segments[id], kMergeGap));
  return true;
}

}  // namespace

void mergeNeighbours(WorkingSet& set) {
  set.enterAll(kMergeGap);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t id = 0; id < set.segments.size(); ++id)
      while (set.segments[id].alive && mergeBest(static_cast<int>(id), set)) changed = true;
  }
}

}  // namespace gaussmap::detail
