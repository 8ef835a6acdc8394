// SPDX-License-Identifier: BSD-3-Clause
#include "segments/new_segments.h"

#include <limits>

namespace gaussmap::detail {
namespace {

constexpr std::size_t kMinToSplit = 4;  // beams

/// Returns the best break point in the order of the beams. The order along a line would be wrong for a run that turns
/// back on itself: it would mix the two arms.
std::size_t bestBreakOfBeams(const ScanBeams& beams, std::size_t first, std::size_t last) {
  LineMoments left, right;
  for (std::size_t i = first; i < last; ++i) right.add(beams.hits[i]);
  std::size_t best = first + 1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = first; i + 1 < last; ++i) {
    left.add(beams.hits[i]);
    right.add(beams.hits[i], -1.0);
    const double error = squaredError(left) + squaredError(right);
    if (error < least) {
      least = error;
      best = i + 1;
    }
  }
  return best;
}

/// Returns a segment of the ends of these beams, for a vote only.
LiveSegment segmentOf(const ScanBeams& beams, std::size_t first, std::size_t last, double cell) {
  LiveSegment segment;
  LineMoments sum;
  for (std::size_t i = first; i < last; ++i) {
    sum.add(beams.hits[i]);
    segment.view += (beams.sensor() - beams.hits[i]).normalized();
  }
  segment.line = fitEvidence(sum, facing(segment.view, {1.0, 0.0}));
  segment.evidence.row = CellRow(segment.line.center, segment.line.direction, cell);
  for (std::size_t i = first; i < last; ++i) segment.evidence.row.add(beams.hits[i], 1.0);
  refit(segment);
  return segment;
}

}  // namespace

void NewSegments::createFrom(const ScanBeams& beams, std::size_t first, std::size_t last, std::vector<int>& owners,
                             std::vector<int>& created) {
  const LiveSegment whole = segmentOf(beams, first, last, cell_);
  if (last - first >= kMinToSplit) {
    const std::size_t cut = bestBreakOfBeams(beams, first, last);
    const SegmentGoals goals = whole.goals();
    const double vote =
        votes_.split(goals, segmentOf(beams, first, cut, cell_).goals(), segmentOf(beams, cut, last, cell_).goals());
    if (vote > votes_.nothing(goals)) {
      createFrom(beams, first, cut, owners, created);
      createFrom(beams, cut, last, owners, created);
      return;
    }
  }
  const int id = store_.create();
  LiveSegment& segment = store_[id];
  segment.line = whole.line;
  segment.begin = whole.begin;
  segment.end = whole.end;
  segment.evidence.row = CellRow(whole.line.center, whole.line.direction, cell_);
  created.push_back(id);
  for (std::size_t i = first; i < last; ++i) {
    owners[i] = id;
    collector_.take(beams, i, segment);
  }
}

}  // namespace gaussmap::detail
