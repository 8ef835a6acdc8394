// SPDX-License-Identifier: BSD-3-Clause
#include "segments/optimise_claims.h"

#include <algorithm>

namespace gaussmap::detail {
namespace {

constexpr double kSameSideCosine = 0.5;  // minimum cosine of the angle between segments of ClaimSide::Same
constexpr double kClaimReach = 0.08;     // a segment claims atoms up to this far beyond its ends [m]

}  // namespace

std::vector<std::vector<Claim>> claimsOf(WorkingSet& set, ClaimSide side) {
  set.enterAll(kClaimReach);
  std::vector<std::vector<Claim>> result(set.atoms.size());
  for (std::size_t i = 0; i < set.atoms.size(); ++i) {
    const Vector<2> mean = set.atoms[i].hits.mean();
    for (const int id : set.index.near(mean)) {
      const LiveSegment& segment = set.segments[id];
      if (side == ClaimSide::Same &&
          segment.line.direction.dot(set.originals[set.atoms[i].owner].line.direction) < kSameSideCosine)
        continue;
      const double t = segment.line.position(mean);
      if (t < segment.begin - kClaimReach || t > segment.end + kClaimReach) continue;
      const double explained = set.score.explained(set.atoms[i].hits, segment.line);
      if (explained > 0.0) result[i].push_back({id, explained});
    }
    std::sort(result[i].begin(), result[i].end(), [](const Claim& a, const Claim& b) {
      return a.explained != b.explained ? a.explained > b.explained : a.segment < b.segment;
    });
  }
  return result;
}

void reassign(WorkingSet& set) {
  const std::vector<std::vector<Claim>> all = claimsOf(set, ClaimSide::Same);
  for (LiveSegment& segment : set.segments)
    for (SegmentCell& cell : segment.evidence.row.cells()) cell.hits = LineMoments();
  for (std::size_t i = 0; i < set.atoms.size(); ++i) {
    if (all[i].empty()) continue;
    CellRow& row = set.segments[all[i].front().segment].evidence.row;
    row.at(row.index(set.atoms[i].hits.mean())).hits += set.atoms[i].hits;
  }
  for (std::size_t i = 0; i < set.segments.size(); ++i) {
    const int id = static_cast<int>(i);
    if (!set.segments[id].alive) continue;
    set.segments[id].evidence.row.trim();
    if (set.segments[id].evidence.row.empty())
      set.remove(id);
    else
      refit(set.segments[id]);
  }
}

void removeRedundant(WorkingSet& set) {
  const std::vector<std::vector<Claim>> all = claimsOf(set, ClaimSide::Any);
  // The margin is the number of observations that only this segment explains. An atom adds the difference between its
  // best claim and the next.
  std::vector<double> margins(set.segments.size(), 0.0), costs(set.segments.size(), 0.0);
  std::vector<std::vector<std::size_t>> claimed(set.segments.size());
  const auto count = [&](std::size_t atom, double sign) {
    const Claim* best = nullptr;
    double second = 0.0;
    for (const Claim& claim : all[atom]) {
      if (!set.segments[claim.segment].alive) continue;
      if (best) {
        second = claim.explained;
        break;
      }
      best = &claim;
    }
    if (best) margins[best->segment] += sign * (best->explained - second);
  };
  for (std::size_t atom = 0; atom < all.size(); ++atom) {
    count(atom, 1.0);
    for (const Claim& claim : all[atom]) claimed[claim.segment].push_back(atom);
  }
  for (std::size_t id = 0; id < set.segments.size(); ++id)
    costs[id] = set.score.costOf(set.segments[id].evidence.row.cells());
  for (;;) {
    int worst = kNone;
    double least = 0.0;
    for (std::size_t i = 0; i < set.segments.size(); ++i) {
      const int id = static_cast<int>(i);
      const double score = margins[i] - costs[i];
      if (!set.segments[id].alive || score >= least || set.closesCorner(id)) continue;
      least = score;
      worst = id;
    }
    if (worst == kNone) return;
    for (const std::size_t atom : claimed[worst]) count(atom, -1.0);
    set.remove(worst);
    for (const std::size_t atom : claimed[worst]) count(atom, 1.0);
  }
}

}  // namespace gaussmap::detail
