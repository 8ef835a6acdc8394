// SPDX-License-Identifier: BSD-3-Clause
#include "segments/optimise_fill.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "segments/optimise_claims.h"

namespace gaussmap::detail {
namespace {

constexpr double kFillReach = 1.0;      // maximum distance of a new segment's atoms from the first one [m]
constexpr double kShortestBase = 0.05;  // minimum distance of two atoms that define a direction [m]
constexpr double kLittle = 4.0;         // a segment explains little if its score is below this many segment costs

/// Searches for lines through atoms that no segment explains.
class LineSearch {
 public:
  struct Line {
    double score = 0.0;
    LineFit line;
    std::vector<int> members;  // atoms
  };

  LineSearch(const WorkingSet& set, const std::vector<int>& left) : set_(set) {
    for (const int atom : left) lattice_[key(mean(atom), 0, 0)].push_back(atom);
  }

  /// Returns the atoms near an atom, and the atom itself.
  std::vector<int> around(int atom) const {
    std::vector<int> near;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell = lattice_.find(key(mean(atom), dx, dy));
        if (cell == lattice_.end()) continue;
        for (const int other : cell->second)
          if ((mean(other) - mean(atom)).norm() < kFillReach) near.push_back(other);
      }
    return near;
  }

  /// Returns the best line through an atom: to one of the atoms near it, or along the atom's owner.
  Line bestThrough(int atom, const std::vector<int>& near) const {
    Line best;
    for (const int other : near) {
      LineFit line;
      line.center = mean(atom);
      const Vector<2> step = mean(other) - mean(atom);
      const double length = step.norm();
      if (other == atom)
        line.direction = set_.originals[set_.atoms[atom].owner].line.direction;
      else if (length < kShortestBase)
        continue;
      else
        line.direction = step / length;
      Line found = along(line, near);
      if (found.score > best.score) best = std::move(found);
    }
    return best;
  }

  /// Returns the range of a line through these atoms that has the highest score. The score is 0 if none is above 0.
  Line along(const LineFit& line, const std::vector<int>& atoms) const {
    Line found;
    found.line = line;
    double bound = 0.0;
    std::vector<int> within;
    for (const int atom : atoms) {
      const double explained = set_.score.explained(set_.atoms[atom].hits, line);
      if (explained <= 0.0) continue;
      bound += explained;
      within.push_back(atom);
    }
    if (bound <= set_.score.segment_cost) return found;
    CellRow row(line.center, line.direction, set_.cell_size);
    for (const int atom : within) row.at(row.index(mean(atom))).hits += set_.atoms[atom].hits;
    ScoredRange best;
    for (const ScoredRange& range : bestRanges(row, line, set_.score))
      if (range.score > best.score) best = range;
    found.score = best.score;
    for (const int atom : within) {
      const int cell = row.index(mean(atom)) - row.first();
      if (cell >= static_cast<int>(best.first) && cell < static_cast<int>(best.last)) found.members.push_back(atom);
    }
    return found;
  }

 private:
  Vector<2> mean(int atom) const { return set_.atoms[atom].hits.mean(); }

  static std::uint64_t key(const Vector<2>& place, int dx, int dy) {
    const auto x = static_cast<std::int64_t>(std::floor(place.x() / kFillReach)) + dx,
               y = static_cast<std::int64_t>(std::floor(place.y() / kFillReach)) + dy;
    return (static_cast<std::uint64_t>(x) << 32) ^ (static_cast<std::uint64_t>(y) & 0xFFFFFFFFu);
  }

  const WorkingSet& set_;
  std::unordered_map<std::uint64_t, std::vector<int>> lattice_;
};

/// Returns a segment of these atoms along a line.
LiveSegment fromAtoms(const WorkingSet& set, const std::vector<int>& members, const LineFit& line) {
  LiveSegment segment;
  segment.alive = true;
  segment.line = line;
  segment.evidence.row = CellRow(line.center, line.direction, set.cell_size);
  for (const int i : members) {
    const EvidenceAtom& atom = set.atoms[i];
    const LiveSegment& owner = set.originals[atom.owner];
    segment.evidence.row.at(segment.evidence.row.index(atom.hits.mean())).hits += atom.hits;
    LineSpread spread = owner.spread.part(atom.share);
    spread.shift(owner.line.position(line.center));
    segment.spread.absorb(spread);
    segment.view += atom.share * owner.view;
    segment.last_seen = std::max(segment.last_seen, owner.last_seen);
  }
  refit(segment);
  return segment;
}

}  // namespace

void fillGaps(WorkingSet& set) {
  for (std::size_t i = 0; i < set.segments.size(); ++i) {
    const int id = static_cast<int>(i);
    const LiveSegment& segment = set.segments[id];
    if (segment.alive && segment.length() < kFillReach && !set.closesCorner(id) &&
        set.score.scoreOf(segment) < kLittle * set.score.segment_cost)
      set.remove(id);
  }
  std::vector<int> left;
  const std::vector<std::vector<Claim>> all = claimsOf(set, ClaimSide::Any);
  for (std::size_t i = 0; i < set.atoms.size(); ++i)
    if (all[i].empty()) left.push_back(static_cast<int>(i));

  const LineSearch search(set, left);
  struct Candidate {
    LineSearch::Line found;
    std::vector<int> near;
  };
  std::vector<Candidate> candidates;
  for (const int atom : left) {
    std::vector<int> near = search.around(atom);
    LineSearch::Line found = search.bestThrough(atom, near);
    if (found.score > 0.0) candidates.push_back({std::move(found), std::move(near)});
  }
  // Takes the best candidate first. The next ones get only the atoms that are still unexplained.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.found.score > b.found.score; });
  std::vector<bool> used(set.atoms.size(), false);
  for (Candidate& candidate : candidates) {
    std::vector<int>& near = candidate.near;
    near.erase(std::remove_if(near.begin(), near.end(), [&](int atom) { return used[atom]; }), near.end());
    const LineSearch::Line found = search.along(candidate.found.line, near);
    if (found.score <= 0.0) continue;
    set.segments.push_back(fromAtoms(set, found.members, found.line));
    for (const int atom : found.members) used[atom] = true;
  }
}

}  // namespace gaussmap::detail
