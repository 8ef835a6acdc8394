// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "segments/fitter_state.h"

namespace gaussmap {
using namespace detail;

using namespace detail;

namespace {

constexpr std::size_t kFewestToSplit = 4;  // beams

/// The break point by prefix sums in the order of the beams: along a run that turns back on itself, positions along a
/// line would mix its two arms.
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

}  // namespace

LiveSegment SegmentFitterState::segmentOf(const ScanBeams& beams, std::size_t first, std::size_t last) const {
  LiveSegment segment;
  LineMoments sum;
  for (std::size_t i = first; i < last; ++i) {
    sum.add(beams.hits[i]);
    segment.view += (beams.sensor() - beams.hits[i]).normalized();
  }
  segment.line = fitEvidence(sum, facing(segment.view, {1.0, 0.0}));
  segment.evidence.row = CellRow(segment.line.center, segment.line.direction, options.cell);
  for (std::size_t i = first; i < last; ++i) segment.evidence.row.add(beams.hits[i], 1.0);
  refit(segment);
  return segment;
}

void SegmentFitterState::createFrom(const ScanBeams& beams, std::size_t first, std::size_t last,
                                    std::vector<int>& owners, std::vector<int>& touched) {
  const LiveSegment whole = segmentOf(beams, first, last);
  if (last - first >= kFewestToSplit) {
    const std::size_t cut = bestBreakOfBeams(beams, first, last);
    const SegmentGoals goals = inMap(whole.goals());
    const double vote =
        utility->split(goals, inMap(segmentOf(beams, first, cut).goals()), inMap(segmentOf(beams, cut, last).goals()));
    if (vote > utility->nothing(goals)) {
      createFrom(beams, first, cut, owners, touched);
      createFrom(beams, cut, last, owners, touched);
      return;
    }
  }
  const int id = create();
  LiveSegment& segment = segments[id];
  segment.line = whole.line;
  segment.evidence.row = CellRow(whole.line.center, whole.line.direction, options.cell);
  touched.push_back(id);
  for (std::size_t i = first; i < last; ++i) {
    owners[i] = id;
    take(beams, i, segment);
  }
}

}  // namespace gaussmap
