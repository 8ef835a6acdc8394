// SPDX-License-Identifier: BSD-3-Clause
#include "segments/optimise.h"

#include <utility>
#include <vector>

#include "segments/optimise_claims.h"
#include "segments/optimise_fill.h"
#include "segments/optimise_merge.h"
#include "segments/working_set.h"

namespace gaussmap::detail {
namespace {

/// Replaces each segment by the ranges of it that score best. Counts all rays that passed through them.
void cutToRanges(const Views& views, WorkingSet& set) {
  std::deque<LiveSegment>& segments = set.segments;
  views.countCrossings(segments);
  const std::size_t count = segments.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int id = static_cast<int>(i);
    if (!segments[id].alive || set.closesCorner(id)) continue;
    const std::vector<ScoredRange> ranges = bestRanges(segments[id].evidence.row, segments[id].line, set.score);
    if (ranges.size() == 1 && ranges[0].last - ranges[0].first == segments[id].evidence.row.cells().size()) continue;
    const int next = segments[id].next, previous = segments[id].previous;
    detach(id, segments);
    const LiveSegment whole = std::move(segments[id]);
    segments[id] = LiveSegment();
    if (ranges.empty()) continue;
    int last = id;
    for (const ScoredRange& range : ranges) {
      if (&range != &ranges.front()) {
        last = static_cast<int>(segments.size());
        segments.emplace_back();
      }
      segments[last] = partOf(whole, range.first, range.last);
    }
    if (previous != kNone) link(previous, id, segments);
    if (next != kNone) link(last, next, segments);
  }
}

}  // namespace

std::deque<LiveSegment> optimiseSegments(const std::deque<LiveSegment>& segments, const Views& views,
                                         const SegmentFitterOptions& options) {
  WorkingSet set(segments, options);
  set.linkNear();
  cutToRanges(views, set);
  for (int round = 0; round < options.optimisation.rounds; ++round) {
    mergeNeighbours(set);
    reassign(set);
    set.linkNear();
    fillGaps(set);
    cutToRanges(views, set);
    removeRedundant(set);
  }
  return set.result();
}

}  // namespace gaussmap::detail
