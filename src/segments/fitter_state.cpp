// SPDX-License-Identifier: BSD-3-Clause
#include "segments/fitter_state.h"

#include <algorithm>

#include "segments/association.h"
#include "segments/decide.h"
#include "segments/new_segments.h"

namespace gaussmap::detail {
namespace {

constexpr double kCovered = 0.1;  // a beam's end is covered if a segment is at most this far from it [m]
constexpr int kPruneEvery = 10;   // scans

}  // namespace

SegmentStatistics SegmentFitterState::add(const LaserScan& original) {
  if (scans == 0) votes.setOrigin(original.pose.translation.array().round().matrix());
  const ScanBeams beams(original, votes.origin(), observations);
  collector.observe(beams);  // may throw, so nothing is changed before
  votes.observe(original.pose.translation);
  SegmentStatistics statistics;

  // Associates beams with the existing segments. The other beams become new segments.
  const std::vector<BeamRun> runs = findRuns(beams, options.gap);
  std::vector<int> owners = associate(beams, runs, collector, store, options), touched;
  for (const BeamRun& run : runs) {
    statistics.beams += run.last - run.first;
    for (std::size_t i = run.first; i < run.last; ++i) {
      if (owners[i] == kNone) continue;
      ++statistics.associated;
      if (store[owners[i]].beams.n == 0.0) touched.push_back(owners[i]);
      collector.take(beams, i, store[owners[i]]);
    }
  }
  const std::size_t known = touched.size();
  NewSegments new_segments(votes, options.cell, collector, store);
  for (const BeamRun& run : runs)
    for (std::size_t i = run.first; i < run.last; ++i) {
      if (owners[i] != kNone) continue;
      const std::size_t first = i;
      while (i + 1 < run.last && owners[i + 1] == kNone) ++i;
      new_segments.createFrom(beams, first, i + 1, owners, touched);
    }
  statistics.created = touched.size() - known;

  for (const int id : touched) {
    collector.settle(beams, scans, store[id]);
    store.enter(id);
  }
  linkNeighbours(runs, owners);

  vote(std::move(touched), statistics);
  if (options.prune) {
    countCrossings(beams, 1.0, store.segments());
    if (scans % kPruneEvery == kPruneEvery - 1) statistics.pruned = store.prune();
  }
  views.add(beams.scan);
  ++scans;
  observations += beams.hits.size();
  describe(statistics);
  statistics.coverage = coverage(beams);
  return statistics;
}

SegmentStatistics SegmentFitterState::observe(const Vector<2>& position) {
  SegmentStatistics statistics;
  votes.observe(position);
  vote({}, statistics);
  describe(statistics);
  return statistics;
}

void SegmentFitterState::vote(std::vector<int> touched, SegmentStatistics& statistics) {
  for (int id = 0; id < static_cast<int>(store.segments().size()); ++id) {
    LiveSegment& segment = store[id];
    if (!segment.alive || !votes.reconsider(segment)) continue;
    segment.decided_at = 0.0;
    touched.push_back(id);
  }
  const DecisionCounts decisions = decide(touched, votes, options, store);
  statistics.splits = decisions.splits;
  statistics.merges = decisions.merges;
}

void SegmentFitterState::linkNeighbours(const std::vector<BeamRun>& runs, const std::vector<int>& owners) {
  for (const BeamRun& run : runs)
    for (std::size_t i = run.first + 1; i < run.last; ++i) {
      const int from = owners[i - 1], to = owners[i];
      if (from != to && (store[to].start() - store[from].finish()).norm() <= options.gap)
        link(from, to, store.segments());
    }
}

void SegmentFitterState::describe(SegmentStatistics& statistics) const {
  double weight = 0.0;
  for (const LiveSegment& segment : store.segments())
    if (segment.alive) {
      ++statistics.segments;
      weight += segment.total.n;
      statistics.normal_variance += segment.total.n * segment.line.across;
    }
  if (weight > 0.0) statistics.normal_variance /= weight;
}

double SegmentFitterState::coverage(const ScanBeams& beams) const {
  std::size_t covered = 0, returned = 0;
  for (std::size_t i = 0; i < beams.hits.size(); ++i) {
    if (!beams.scan.returned(i)) continue;
    ++returned;
    const std::vector<int>& near = store.near(beams.hits[i]);
    covered += std::any_of(near.begin(), near.end(),
                           [&](int id) { return store[id].squaredDistance(beams.hits[i]) <= kCovered * kCovered; });
  }
  return returned > 0 ? static_cast<double>(covered) / static_cast<double>(returned) : 0.0;
}

}  // namespace gaussmap::detail
