// SPDX-License-Identifier: BSD-3-Clause
#include "segments/association.h"

#include <algorithm>
#include <limits>

namespace gaussmap::detail {
namespace {

// A straight segment accepts a piece of surface only if the cosine of the angle between both is at least kTilt.
// Pieces shorter than kShort have less certain directions, so kTiltShort is their limit.
constexpr double kTilt = 0.77;
constexpr double kShort = 0.25;  // [m]
constexpr double kTiltShort = 0.5;

/// Returns the number of the segment that a beam's end belongs to, or kNone. `piece`: its result of straightPieces().
int segmentOfHit(const Vector<2>& hit, const Vector<2>& sensor, const Vector<2>& piece, const SegmentStore& store,
                 double min_half_width) {
  const double length = piece.norm(), tilt = length < kShort ? kTiltShort : kTilt;
  int best = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (const int id : store.near(hit)) {
    const LiveSegment& segment = store[id];
    if (segment.line.offset(sensor) <= 0.0) continue;  // seen from behind
    const double distance = segment.squaredDistance(hit);
    if (distance >= least || !store.polygon(segment).contains(hit)) continue;
    // A straight segment (3 sigma_n <= min_half_width) refuses surfaces of another direction. A coarse one does not.
    const bool straight = 9.0 * segment.line.across <= min_half_width * min_half_width;
    if (straight && segment.line.direction.dot(piece) < tilt * length && !segment.degenerate()) continue;
    least = distance;
    best = id;
  }
  return best;
}

/// Returns the number of the nearest segment whose polygon contains the point, or kNone.
int segmentAround(const Vector<2>& point, const SegmentStore& store) {
  int best = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (const int id : store.near(point)) {
    const double distance = store[id].squaredDistance(point);
    if (distance >= least || !store.polygon(store[id]).contains(point)) continue;
    least = distance;
    best = id;
  }
  return best;
}

}  // namespace

std::vector<int> associate(const ScanBeams& beams, const std::vector<BeamRun>& runs,
                           const EvidenceCollector& observations, const SegmentStore& store,
                           const SegmentFitterOptions& options) {
  std::vector<int> owners(beams.hits.size(), kNone);
  if (options.association == SegmentAssociation::Polygon) {
    for (const BeamRun& run : runs)
      for (std::size_t i = run.first; i < run.last; ++i) owners[i] = segmentAround(observations.mean(i), store);
    return owners;
  }
  const std::vector<Vector<2>> pieces = straightPieces(runs, beams.hits, 3.0 * std::max(options.noise.range, 0.01));
  for (const BeamRun& run : runs)
    for (std::size_t i = run.first; i < run.last; ++i)
      owners[i] = segmentOfHit(beams.hits[i], beams.sensor(), pieces[i], store, options.min_half_width);
  return owners;
}

}  // namespace gaussmap::detail
