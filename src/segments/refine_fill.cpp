// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "segments/refinement.h"

namespace gaussmap::detail {
namespace {

constexpr double kFillReach = 1.0;      // how far what becomes a new segment lies from one atom of it [m]
constexpr double kShortestBase = 0.05;  // between two atoms that give a direction [m]
constexpr double kLittle = 4.0;         // a segment explains little if it is worth less than so many segments cost

}  // namespace

/// Looks for lines through atoms that no segment explains.
class Refinement::Search {
 public:
  struct Line {
    double worth = 0.0;
    LineFit line;
    std::vector<int> members;  // atoms
  };

  Search(const Refinement& refinement, const std::vector<int>& left) : own_(refinement) {
    for (const int atom : left) lattice_[key(mean(atom), 0, 0)].push_back(atom);
  }

  /// Atoms around one of them.
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

  /// The best line through an atom and one of those around it, or along what it was part of.
  Line bestThrough(int atom, const std::vector<int>& near) const {
    Line best;
    for (const int other : near) {
      LineFit line;
      line.center = mean(atom);
      const Vector<2> step = mean(other) - mean(atom);
      const double length = step.norm();
      if (other == atom)
        line.direction = own_.state_.segments[own_.atoms_[atom].owner].line.direction;
      else if (length < kShortestBase)
        continue;
      else
        line.direction = step / length;
      Line found = along(line, near);
      if (found.worth > best.worth) best = std::move(found);
    }
    return best;
  }

  /// The stretch of a line through these atoms that is worth most; worth 0 if none is worth anything.
  Line along(const LineFit& line, const std::vector<int>& atoms) const {
    Line found;
    found.line = line;
    double bound = 0.0;
    std::vector<int> within;
    for (const int atom : atoms) {
      const double explained = own_.worth_.explained(own_.atoms_[atom].hits, line);
      if (explained <= 0.0) continue;
      bound += explained;
      within.push_back(atom);
    }
    if (bound <= own_.worth_.segment_cost) return found;
    CellRow row(line.center, line.direction, own_.state_.options.cell);
    for (const int atom : within) row.at(row.index(mean(atom))).hits += own_.atoms_[atom].hits;
    CellRange best;
    for (const CellRange& range : worthKeeping(row, line, own_.worth_))
      if (range.worth > best.worth) best = range;
    found.worth = best.worth;
    for (const int atom : within) {
      const int cell = row.index(mean(atom)) - row.first();
      if (cell >= static_cast<int>(best.first) && cell < static_cast<int>(best.last)) found.members.push_back(atom);
    }
    return found;
  }

 private:
  Vector<2> mean(int atom) const { return own_.atoms_[atom].hits.mean(); }

  static std::uint64_t key(const Vector<2>& place, int dx, int dy) {
    const auto x = static_cast<std::int64_t>(std::floor(place.x() / kFillReach)) + dx,
               y = static_cast<std::int64_t>(std::floor(place.y() / kFillReach)) + dy;
    return (static_cast<std::uint64_t>(x) << 32) ^ (static_cast<std::uint64_t>(y) & 0xFFFFFFFFu);
  }

  const Refinement& own_;
  std::unordered_map<std::uint64_t, std::vector<int>> lattice_;
};

void Refinement::fill() {
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const int id = static_cast<int>(i);
    const LiveSegment& segment = segments_[id];
    if (segment.alive && segment.length() < kFillReach && !closesCorner(id) &&
        worth_.of(segment) < kLittle * worth_.segment_cost)
      remove(id);
  }
  std::vector<int> left;
  const std::vector<std::vector<Claim>> all = claims(Side::Any);
  for (std::size_t i = 0; i < atoms_.size(); ++i)
    if (all[i].empty()) left.push_back(static_cast<int>(i));

  const Search search(*this, left);
  struct Candidate {
    Search::Line found;
    std::vector<int> near;
  };
  std::vector<Candidate> candidates;
  for (const int atom : left) {
    std::vector<int> near = search.around(atom);
    Search::Line found = search.bestThrough(atom, near);
    if (found.worth > 0.0) candidates.push_back({std::move(found), std::move(near)});
  }
  // The best first; of the others what is left to explain.
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.found.worth > b.found.worth; });
  std::vector<bool> used(atoms_.size(), false);
  for (Candidate& candidate : candidates) {
    std::vector<int>& near = candidate.near;
    near.erase(std::remove_if(near.begin(), near.end(), [&](int atom) { return used[atom]; }), near.end());
    const Search::Line found = search.along(candidate.found.line, near);
    if (found.worth <= 0.0) continue;
    segments_.push_back(fromAtoms(found.members, found.line));
    for (const int atom : found.members) used[atom] = true;
  }
}

LiveSegment Refinement::fromAtoms(const std::vector<int>& members, const LineFit& line) const {
  LiveSegment segment;
  segment.alive = true;
  segment.line = line;
  segment.evidence.row = CellRow(line.center, line.direction, state_.options.cell);
  for (const int i : members) {
    const Atom& atom = atoms_[i];
    const LiveSegment& owner = state_.segments[atom.owner];
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

}  // namespace gaussmap::detail
