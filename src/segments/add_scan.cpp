// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "segments/fitter_state.h"
#include "segments/scan_pieces.h"

namespace gaussmap {
using namespace detail;

using namespace detail;

namespace {

constexpr double kTilt = 0.77;   // cosine of the greatest angle between a surface and the segment that it falls to ...
constexpr double kShort = 0.25;  // ... for pieces of surface that are longer than this [m] ...
constexpr double kTiltShort = 0.5;  // ... and for shorter ones, whose directions are less certain
constexpr double kCovered = 0.1;    // distance within which a beam's end counts as covered [m]
constexpr int kPruneEvery = 10;     // scans

}  // namespace

SegmentStatistics SegmentFitterState::add(const LaserScan& original) {
  if (scans == 0) origin = original.pose.translation.array().round().matrix();
  utility->observe(original.pose.translation);
  const ScanBeams beams(original, origin, observations);
  const std::size_t count = beams.hits.size();
  SegmentStatistics statistics;

  const std::vector<BeamRun> runs = findRuns(beams, options.gap);
  const std::vector<Vector<2>> pieces = straightPieces(runs, beams.hits, 3.0 * std::max(options.noise.range, 0.01));

  // Every beam falls to a segment of the map as it was; what is left becomes new ones.
  std::vector<int> owners(count, kNone), touched;
  for (const BeamRun& run : runs) {
    statistics.beams += run.last - run.first;
    for (std::size_t i = run.first; i < run.last; ++i) {
      owners[i] = associate(beams.hits[i], beams.sensor(), pieces[i]);
      if (owners[i] == kNone) continue;
      ++statistics.associated;
      LiveSegment& segment = segments[owners[i]];
      if (segment.beams.n == 0.0) touched.push_back(owners[i]);
      take(beams, i, segment);
    }
  }
  const std::size_t known = touched.size();
  for (const BeamRun& run : runs)
    for (std::size_t i = run.first; i < run.last; ++i) {
      if (owners[i] != kNone) continue;
      const std::size_t first = i;
      while (i + 1 < run.last && owners[i + 1] == kNone) ++i;
      createFrom(beams, first, i + 1, owners, touched);
    }
  statistics.created = touched.size() - known;

  for (const int id : touched) {
    LiveSegment& segment = segments[id];
    segment.spread.addScan(segment.beams, segment.line, beams.sensor(), original.pose.covariance, scans);
    segment.beams = BeamSums();
    segment.last_seen = scans;
    keeper->settle(segment.length(), settled++, segment.evidence);
    refit(segment);
    enter(id);
  }
  for (const BeamRun& run : runs)
    for (std::size_t i = run.first + 1; i < run.last; ++i) {
      const int from = owners[i - 1], to = owners[i];
      if (from != to && (segments[to].start() - segments[from].finish()).norm() <= options.gap)
        link(from, to, segments);
    }

  for (int id = 0; id < static_cast<int>(segments.size()); ++id) {
    LiveSegment& segment = segments[id];
    if (!segment.alive || !utility->reconsider(segment.start() + origin, segment.finish() + origin)) continue;
    segment.decided_at = 0.0;
    touched.push_back(id);
  }
  decide(touched, statistics);
  if (options.prune) {
    countCrossings(beams, 1.0, segments);
    if (scans % kPruneEvery == kPruneEvery - 1) statistics.pruned = prune();
  }
  views.add(beams.scan);
  ++scans;
  observations += count;
  describe(beams, statistics);
  return statistics;
}

int SegmentFitterState::associate(const Vector<2>& hit, const Vector<2>& sensor, const Vector<2>& piece) const {
  const double length = piece.norm(), tilt = length < kShort ? kTiltShort : kTilt;
  int best = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (const int id : index.near(hit)) {
    const LiveSegment& segment = segments[id];
    if (segment.line.offset(sensor) <= 0.0) continue;  // seen from behind
    const double distance = segment.squaredDistance(hit);
    if (distance >= least || !polygon(segment).contains(hit)) continue;
    // What is straight takes no part of another surface; a coarse segment takes all.
    const bool straight = 9.0 * segment.line.across <= options.min_half_width * options.min_half_width;
    if (straight && segment.line.direction.dot(piece) < tilt * length && !segment.degenerate()) continue;
    least = distance;
    best = id;
  }
  return best;
}

void SegmentFitterState::take(const ScanBeams& beams, std::size_t beam, LiveSegment& segment) {
  model->observe(beams.scan, beam, beams.first_number + beam, points);
  keeper->add(points, segment.evidence);
  const Vector<2>& hit = beams.hits[beam];
  const double t = segment.line.position(hit), range = beams.scan.ranges[beam];
  const Vector<2> back = (beams.sensor() - hit) / range;
  segment.view += back;
  segment.beams.n += 1.0;
  segment.beams.t += t;
  segment.beams.tt += t * t;
  // Across the line: the range's error with the beam's own share of the normal, the bearing's with the rest.
  const double sine = segment.line.normal().dot(back), bearing = range * options.noise.bearing;
  segment.beams.variance +=
      sine * sine * options.noise.range * options.noise.range + (1.0 - sine * sine) * bearing * bearing;
}

void SegmentFitterState::describe(const ScanBeams& beams, SegmentStatistics& statistics) const {
  double weight = 0.0;
  for (const LiveSegment& segment : segments)
    if (segment.alive) {
      ++statistics.segments;
      weight += segment.total.n;
      statistics.normal_variance += segment.total.n * segment.line.across;
    }
  if (weight > 0.0) statistics.normal_variance /= weight;
  std::size_t covered = 0;
  for (std::size_t i = 0; i < beams.hits.size(); ++i) {
    if (!beams.scan.returned(i)) continue;
    const std::vector<int>& near = index.near(beams.hits[i]);
    covered += std::any_of(near.begin(), near.end(),
                           [&](int id) { return segments[id].squaredDistance(beams.hits[i]) <= kCovered * kCovered; });
  }
  if (statistics.beams > 0) statistics.coverage = static_cast<double>(covered) / static_cast<double>(statistics.beams);
}

}  // namespace gaussmap
