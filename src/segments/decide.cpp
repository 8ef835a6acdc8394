// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "segments/fitter_state.h"

namespace gaussmap {
using namespace detail;

using namespace detail;

namespace {

constexpr double kNews = 1.1;       // a segment is decided on again when its evidence has grown so much
constexpr double kParallel = 0.9;   // cosine from which on segments that are not linked may be one
constexpr int kMostDecisions = 10;  // about a segment in one scan: votes that contradict each other would never end

/// Number of the first cell behind a hole without evidence longer than `gap`; 0 if there is none.
std::size_t firstHole(const CellRow& row, double gap) {
  const std::size_t needed = static_cast<std::size_t>(std::ceil(gap / row.size())) + 2;
  std::size_t empty = 0;
  bool begun = false;  // cells without evidence before the first one with some are no hole
  for (std::size_t i = 0; i < row.cells().size(); ++i) {
    if (row.cells()[i].hits.n <= 0.0) {
      ++empty;
    } else {
      if (begun && empty >= needed) return i;
      begun = true;
      empty = 0;
    }
  }
  return 0;
}

}  // namespace

std::vector<int> SegmentFitterState::mergePartners(int id) const {
  const LiveSegment& segment = segments[id];
  std::vector<int> partners;
  // The faces of a thin wall, linked round its end, look away from each other.
  const auto linked = [&](int other, const Vector<2>& own_end, const Vector<2>& other_end) {
    if ((own_end - other_end).norm() > options.gap || segments[other].line.direction.dot(segment.line.direction) <= 0.0)
      return;
    partners.push_back(other);
  };
  if (segment.next != kNone) linked(segment.next, segment.finish(), segments[segment.next].start());
  if (segment.previous != kNone && segment.previous != segment.next)
    linked(segment.previous, segment.start(), segments[segment.previous].finish());
  for (const Vector<2>& place : {segment.start(), segment.line.center, segment.finish()})
    for (const int other : index.near(place)) {
      const LiveSegment& near = segments[other];
      if (other == id || std::find(partners.begin(), partners.end(), other) != partners.end()) continue;
      if (near.line.direction.dot(segment.line.direction) < kParallel) continue;
      if (near.squaredDistance(place) > options.gap * options.gap) continue;
      partners.push_back(other);
    }
  return partners;
}

void SegmentFitterState::decide(const std::vector<int>& touched, SegmentStatistics& statistics) {
  std::deque<int> open(touched.begin(), touched.end());
  const std::size_t most = kMostDecisions * (touched.size() + 1);
  for (std::size_t decisions = 0; !open.empty() && decisions < most; ++decisions) {
    const int id = open.front();
    open.pop_front();
    LiveSegment& segment = segments[id];
    const CellRow& row = segment.evidence.row;
    if (!segment.alive) continue;
    if (segment.total.n < kNews * segment.decided_at && row.cells().size() == segment.decided_cells) continue;
    segment.decided_at = segment.total.n;
    segment.decided_cells = row.cells().size();

    if (const std::size_t hole = firstHole(row, options.gap)) {
      open.push_back(split(id, hole, false));
      open.push_back(id);
      continue;
    }

    const SegmentGoals goals = inMap(segment.goals());
    double highest = utility->nothing(goals);
    std::size_t cut = 0;
    int partner = kNone;
    if (!segment.degenerate()) {
      const std::size_t best = bestBreak(row);
      if (best > 0) {
        const double vote = utility->split(goals, inMap(goalsOfPart(segment, 0, best)),
                                           inMap(goalsOfPart(segment, best, row.cells().size())));
        if (vote > highest) {
          highest = vote;
          cut = best;
        }
      }
    }
    for (const int other : mergePartners(id)) {
      const double vote =
          utility->merge(goals, inMap(segments[other].goals()), inMap(goalsTogether(segment, segments[other])));
      if (vote > highest) {
        highest = vote;
        partner = other;
      }
    }
    if (partner != kNone) {
      ++statistics.merges;
      merge(id, partner);
      open.push_back(id);
    } else if (cut > 0) {
      ++statistics.splits;
      open.push_back(split(id, cut, true));
      open.push_back(id);
    }
  }
}

}  // namespace gaussmap
