// SPDX-License-Identifier: BSD-3-Clause
#include "segments/refinement.h"

namespace gaussmap::detail {
namespace {

constexpr double kParallel = 0.95;  // cosine from which on two segments may be one
constexpr double kGap = 0.3;        // and how far apart they are at most [m]

}  // namespace

void Refinement::merge() {
  enterAll(kGap);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t id = 0; id < segments_.size(); ++id)
      while (segments_[id].alive && mergeBest(static_cast<int>(id))) changed = true;
  }
}

bool Refinement::mergeBest(int id) {
  const LiveSegment& segment = segments_[id];
  const double own = worth_.of(segment);
  double most = 1e-9 * worth_.segment_cost;
  int partner = kNone;
  LiveSegment best;
  std::vector<int> seen;
  for (const Vector<2>& place : {segment.start(), segment.line.center, segment.finish()})
    for (const int other : index_.near(place)) {
      const LiveSegment& near = segments_[other];
      if (other == id || near.line.direction.dot(segment.line.direction) < kParallel ||
          near.squaredDistance(place) > kGap * kGap || std::find(seen.begin(), seen.end(), other) != seen.end())
        continue;
      seen.push_back(other);
      LiveSegment both = merged(segment, near);
      const double gain = worth_.of(both) - own - worth_.of(near);
      if (gain > most) {
        most = gain;
        partner = other;
        best = std::move(both);
      }
    }
  if (partner == kNone) return false;
  int next = segment.next, previous = segment.previous;
  if (next == partner || next == kNone) next = segments_[partner].next;
  if (previous == partner || previous == kNone) previous = segments_[partner].previous;
  index_.erase(partner);
  remove(partner);
  detach(id, segments_);
  segments_[id] = std::move(best);
  if (next != kNone && next != id && next != partner) link(id, next, segments_);
  if (previous != kNone && previous != id && previous != partner) link(previous, id, segments_);
  index_.update(id, strip(segments_[id], kGap));
  return true;
}

}  // namespace gaussmap::detail
