// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "segments/refinement.h"

namespace gaussmap::detail {
namespace {

constexpr double kSame = 0.5;   // cosine from which on segments look the same way
constexpr double kOver = 0.08;  // a segment explains so much beyond its ends [m]

}  // namespace

std::vector<std::vector<Refinement::Claim>> Refinement::claims(Side side) {
  enterAll(kOver);
  std::vector<std::vector<Claim>> result(atoms_.size());
  for (std::size_t i = 0; i < atoms_.size(); ++i) {
    const Vector<2> mean = atoms_[i].hits.mean();
    for (const int id : index_.near(mean)) {
      const LiveSegment& segment = segments_[id];
      if (side == Side::Same && segment.line.direction.dot(state_.segments[atoms_[i].owner].line.direction) < kSame)
        continue;
      const double t = segment.line.position(mean);
      if (t < segment.begin - kOver || t > segment.end + kOver) continue;
      const double explained = worth_.explained(atoms_[i].hits, segment.line);
      if (explained > 0.0) result[i].push_back({id, explained});
    }
    std::sort(result[i].begin(), result[i].end(), [](const Claim& a, const Claim& b) {
      return a.explained != b.explained ? a.explained > b.explained : a.segment < b.segment;
    });
  }
  return result;
}

void Refinement::reassign() {
  const std::vector<std::vector<Claim>> all = claims(Side::Same);
  for (LiveSegment& segment : segments_)
    for (SegmentCell& cell : segment.evidence.row.cells()) cell.hits = LineMoments();
  for (std::size_t i = 0; i < atoms_.size(); ++i) {
    if (all[i].empty()) continue;
    CellRow& row = segments_[all[i].front().segment].evidence.row;
    row.at(row.index(atoms_[i].hits.mean())).hits += atoms_[i].hits;
  }
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const int id = static_cast<int>(i);
    if (!segments_[id].alive) continue;
    segments_[id].evidence.row.trim();
    if (segments_[id].evidence.row.empty())
      remove(id);
    else
      refit(segments_[id]);
  }
}

void Refinement::removeRedundant() {
  const std::vector<std::vector<Claim>> all = claims(Side::Any);
  // What would be explained no more without a segment: of each atom the difference between the best and the next.
  std::vector<double> margins(segments_.size(), 0.0), costs(segments_.size(), 0.0);
  std::vector<std::vector<std::size_t>> claimed(segments_.size());
  const auto count = [&](std::size_t atom, double sign) {
    const Claim* best = nullptr;
    double second = 0.0;
    for (const Claim& claim : all[atom]) {
      if (!segments_[claim.segment].alive) continue;
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
  for (std::size_t id = 0; id < segments_.size(); ++id) costs[id] = worth_.costOf(segments_[id].evidence.row.cells());
  for (;;) {
    int worst = kNone;
    double least = 0.0;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      const int id = static_cast<int>(i);
      const double worth = margins[i] - costs[i];
      if (!segments_[id].alive || worth >= least || closesCorner(id)) continue;
      least = worth;
      worst = id;
    }
    if (worst == kNone) return;
    for (const std::size_t atom : claimed[worst]) count(atom, -1.0);
    remove(worst);
    for (const std::size_t atom : claimed[worst]) count(atom, 1.0);
  }
}

}  // namespace gaussmap::detail
