// SPDX-License-Identifier: BSD-3-Clause
#include "segments/refinement.h"

#include <algorithm>
#include <cmath>

#include "segments/refine.h"

namespace gaussmap::detail {
namespace {

constexpr double kNear = 0.15;       // ends that are linked without a scan that linked them [m]
constexpr double kCornerSine = 0.7;  // sine from which on neighbours make a corner
constexpr double kCornerGap = 0.2;   // between the ends at a corner [m]

}  // namespace

Refinement::Refinement(const SegmentFitterState& state) : state_(state), segments_(state.segments) {
  double observations = 0.0;
  for (std::size_t id = 0; id < segments_.size(); ++id) {
    LiveSegment& segment = segments_[id];
    segment.evidence.particles = {};  // the rows hold what is needed
    if (!segment.alive) continue;
    // A limited number of particles stands for all observations.
    const double scale =
        state.options.policy == EvidencePolicy::ParticleSets ? segment.spread.beams() / segment.total.n : 1.0;
    segment.total = scale * segment.total;
    for (SegmentCell& cell : segment.evidence.row.cells()) {
      if (cell.hits.n <= 0.0) continue;
      cell.hits = scale * cell.hits;
      atoms_.push_back({cell.hits, static_cast<int>(id), cell.hits.n / segment.total.n});
      observations += cell.hits.n;
    }
  }
  const double average = atoms_.empty() ? 0.0 : observations / static_cast<double>(atoms_.size());
  const SegmentRefinementOptions& options = state.options.refinement;
  worth_ = {options.tolerance, average * options.segment_cost, average * options.cell_cost, average * options.hole_cost,
            options.crossing_cost};
}

void Refinement::cut() {
  state_.views.countCrossings(segments_);
  const std::size_t count = segments_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int id = static_cast<int>(i);
    if (!segments_[id].alive || closesCorner(id)) continue;
    const std::vector<CellRange> ranges = worthKeeping(segments_[id].evidence.row, segments_[id].line, worth_);
    if (ranges.size() == 1 && ranges[0].last - ranges[0].first == segments_[id].evidence.row.cells().size()) continue;
    const int next = segments_[id].next, previous = segments_[id].previous;
    detach(id, segments_);
    const LiveSegment whole = std::move(segments_[id]);
    segments_[id] = LiveSegment();
    if (ranges.empty()) continue;
    int last = id;
    for (const CellRange& range : ranges) {
      if (&range != &ranges.front()) {
        last = static_cast<int>(segments_.size());
        segments_.emplace_back();
      }
      segments_[last] = partOf(whole, range.first, range.last);
    }
    if (previous != kNone) link(previous, id, segments_);
    if (next != kNone) link(last, next, segments_);
  }
}

bool Refinement::closesCorner(int id) const {
  const LiveSegment& segment = segments_[id];
  if (segment.next == kNone || segment.previous == kNone || segment.degenerate()) return false;
  const auto corner = [&](const LiveSegment& other, const Vector<2>& own_end, const Vector<2>& other_end) {
    const Vector<2>&u = segment.line.direction, &v = other.line.direction;
    return std::abs(u.x() * v.y() - u.y() * v.x()) > kCornerSine && (own_end - other_end).norm() < kCornerGap &&
           other.length() > segment.length();
  };
  const LiveSegment &next = segments_[segment.next], &previous = segments_[segment.previous];
  return corner(next, segment.finish(), next.start()) && corner(previous, segment.start(), previous.finish());
}

void Refinement::linkNear() {
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const int id = static_cast<int>(i), next = segments_[id].next;
    if (next != kNone && (segments_[next].start() - segments_[id].finish()).norm() > state_.options.gap)
      unlinkNext(id, segments_);
  }
  struct Pair {
    double distance;
    int from, to;
  };
  std::vector<Pair> pairs;
  enterAll(kNear);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const int from = static_cast<int>(i);
    const LiveSegment& segment = segments_[from];
    if (!segment.alive || segment.next != kNone) continue;
    for (const int to : index_.near(segment.finish())) {
      const double distance = (segments_[to].start() - segment.finish()).norm();
      if (to != from && segments_[to].previous == kNone && distance < kNear) pairs.push_back({distance, from, to});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  for (const Pair& pair : pairs)
    if (segments_[pair.from].next == kNone && segments_[pair.to].previous == kNone) link(pair.from, pair.to, segments_);
}

std::deque<LiveSegment> Refinement::result() {
  linkNear();
  std::vector<int> numbers(segments_.size(), kNone);
  std::deque<LiveSegment> result;
  for (std::size_t id = 0; id < segments_.size(); ++id)
    if (segments_[id].alive) {
      numbers[id] = static_cast<int>(result.size());
      result.push_back(std::move(segments_[id]));
    }
  for (LiveSegment& segment : result) {
    if (segment.next != kNone) segment.next = numbers[segment.next];
    if (segment.previous != kNone) segment.previous = numbers[segment.previous];
  }
  return result;
}

void Refinement::enterAll(double reach) {
  index_ = SegmentIndex();
  for (std::size_t id = 0; id < segments_.size(); ++id)
    if (segments_[id].alive) index_.update(static_cast<int>(id), strip(segments_[id], reach));
}

Strip Refinement::strip(const LiveSegment& segment, double reach) const {
  return {segment.start() - reach * segment.line.direction, segment.line.direction, segment.length() + 2.0 * reach,
          worth_.tolerance};
}

void Refinement::remove(int id) {
  detach(id, segments_);
  segments_[id] = LiveSegment();
}

std::deque<LiveSegment> refineSegments(const SegmentFitterState& state) {
  Refinement refinement(state);
  refinement.linkNear();
  refinement.cut();
  for (int round = 0; round < state.options.refinement.rounds; ++round) {
    refinement.merge();
    refinement.reassign();
    refinement.linkNear();
    refinement.fill();
    refinement.cut();
    refinement.removeRedundant();
  }
  return refinement.result();
}

}  // namespace gaussmap::detail
