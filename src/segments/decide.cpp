// SPDX-License-Identifier: BSD-3-Clause
#include "segments/decide.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace gaussmap::detail {
namespace {

constexpr double kGrown = 1.1;          // the votes on a segment are repeated when its weight has grown by this factor
constexpr double kPartnerCosine = 0.9;  // minimum cosine of the angle between merge candidates that are not linked
constexpr std::size_t kMaxDecisions = 10;  // per segment and scan, because contradictory votes would never end

/// Returns the number of the first cell after a hole without evidence that is longer than `gap` [m]; 0 without a hole.
std::size_t firstHole(const CellRow& row, double gap) {
  const std::size_t needed = static_cast<std::size_t>(std::ceil(gap / row.size())) + 2;
  std::size_t empty = 0;
  bool begun = false;  // empty cells before the first evidence are not a hole
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

/// Returns the candidates for a merge, see MergeCandidates.
std::vector<int> mergePartners(int id, const SegmentFitterOptions& options, const SegmentStore& store) {
  const double gap = options.gap;
  const LiveSegment& segment = store[id];
  std::vector<int> partners;
  // Excludes the two faces of a thin wall: they can be linked around its end, but have opposite directions.
  const auto linked = [&](int other, const Vector<2>& own_end, const Vector<2>& other_end) {
    if ((own_end - other_end).norm() > gap || store[other].line.direction.dot(segment.line.direction) <= 0.0) return;
    partners.push_back(other);
  };
  if (segment.next != kNone) linked(segment.next, segment.finish(), store[segment.next].start());
  if (segment.previous != kNone && segment.previous != segment.next)
    linked(segment.previous, segment.start(), store[segment.previous].finish());
  if (options.merge_candidates == MergeCandidates::Linked) return partners;
  for (const Vector<2>& place : {segment.start(), segment.line.center, segment.finish()})
    for (const int other : store.near(place)) {
      const LiveSegment& near = store[other];
      if (other == id || std::find(partners.begin(), partners.end(), other) != partners.end()) continue;
      if (near.line.direction.dot(segment.line.direction) < kPartnerCosine) continue;
      if (near.squaredDistance(place) > gap * gap) continue;
      partners.push_back(other);
    }
  return partners;
}

}  // namespace

DecisionCounts decide(const std::vector<int>& touched, const SegmentVotes& votes, const SegmentFitterOptions& options,
                      SegmentStore& store) {
  const bool evidence_grows =
      options.policy == EvidencePolicy::MomentCells || options.particles.limit == ParticleLimit::Bins;
  DecisionCounts counts;
  std::deque<int> open(touched.begin(), touched.end());
  const std::size_t most = kMaxDecisions * (touched.size() + 1);
  for (std::size_t decisions = 0; !open.empty() && decisions < most; ++decisions) {
    const int id = open.front();
    open.pop_front();
    LiveSegment& segment = store[id];
    const CellRow& row = segment.evidence.row;
    if (!segment.alive) continue;
    if (evidence_grows && segment.total.n < kGrown * segment.decided_at && row.cells().size() == segment.decided_cells)
      continue;
    segment.decided_at = segment.total.n;
    segment.decided_cells = row.cells().size();

    if (const std::size_t hole = options.split_holes ? firstHole(row, options.gap) : 0) {
      open.push_back(store.split(id, hole, false));
      open.push_back(id);
      continue;
    }

    const SegmentGoals goals = segment.goals();
    double highest = votes.nothing(goals);
    std::size_t cut = 0;
    int partner = kNone;
    if (!segment.degenerate()) {
      const std::size_t best = bestBreak(row);
      if (best > 0) {
        const double vote =
            votes.split(goals, goalsOfPart(segment, 0, best), goalsOfPart(segment, best, row.cells().size()));
        if (vote > highest) {
          highest = vote;
          cut = best;
        }
      }
    }
    for (const int other : mergePartners(id, options, store)) {
      const double vote = votes.merge(goals, store[other].goals(), goalsTogether(segment, store[other]));
      if (vote > highest) {
        highest = vote;
        partner = other;
      }
    }
    if (partner != kNone) {
      ++counts.merges;
      store.merge(id, partner);
      open.push_back(id);
    } else if (cut > 0) {
      ++counts.splits;
      open.push_back(store.split(id, cut, true));
      open.push_back(id);
    }
  }
  return counts;
}

}  // namespace gaussmap::detail
