// SPDX-License-Identifier: BSD-3-Clause
#include "segments/association.h"

#include <algorithm>
#include <limits>

namespace gaussmap::detail {
namespace {

constexpr double kTilt = 0.77;  // cosine of the greatest angle between a surface and the segment that it belongs to ...
constexpr double kShort = 0.25;     // ... for pieces of surface that are longer than this [m] ...
constexpr double kTiltShort = 0.5;  // ... and for shorter ones, whose directions are less certain

/// `piece`: of straightPieces().
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
    // A straight segment takes no part of another surface; a coarse segment takes everything.
    const bool straight = 9.0 * segment.line.across <= min_half_width * min_half_width;
    if (straight && segment.line.direction.dot(piece) < tilt * length && !segment.degenerate()) continue;
    least = distance;
    best = id;
  }
  return best;
}

}  // namespace

std::vector<int> associate(const ScanBeams& beams, const std::vector<BeamRun>& runs, const SegmentStore& store,
                           const SegmentFitterOptions& options) {
  const std::vector<Vector<2>> pieces = straightPieces(runs, beams.hits, 3.0 * std::max(options.noise.range, 0.01));
  std::vector<int> owners(beams.hits.size(), kNone);
  for (const BeamRun& run : runs)
    for (std::size_t i = run.first; i < run.last; ++i)
      owners[i] = segmentOfHit(beams.hits[i], beams.sensor(), pieces[i], store, options.min_half_width);
  return owners;
}

}  // namespace gaussmap::detail
