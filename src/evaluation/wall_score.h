// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/segments/segment_map.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

struct WallScoreOptions {
  double tolerance = 0.05;   ///< a wall and a segment match up to this distance [m], > 0
  double spacing = 0.01;     ///< between samples on walls and segments [m], > 0
  double shortest = 0.5;     ///< shorter walls are not used for offsets and angles [m], >= 0
  double corner_deg = 30.0;  ///< two walls that meet form a corner if their directions differ by more [degree]
};

/// How a map of segments differs from the true walls.
struct WallScore {
  double recall = 0.0;     ///< share of the walls' length within the tolerance of a segment; 1 without walls
  double precision = 0.0;  ///< share of the segments' length within the tolerance of a wall; 1 without segments
  /// Number of segments whose middle lies within the tolerance of a long enough wall of the same direction (within 20
  /// degrees). Each is compared with the nearest such wall.
  std::size_t matched = 0;
  double offset_rms = 0.0;  ///< of the offsets of their middles from the walls' lines, weighted by length [m]
  double angle_rms = 0.0;   ///< of the errors of their directions, weighted by length [rad]
  /// Mean of e' C^-1 e over the matched segments, with e = (offset, angle) and C = Segment::covariance. It is 2 if the
  /// covariances are correct.
  double normalised_error = 0.0;
  std::size_t corners = 0;     ///< number of corners of the walls
  double corner_median = 0.0;  ///< of their distances to the nearest end of a segment [m]; infinity without segments
};

/// Compares a map with the true walls. Of `walls` it uses only start and end, with free space on the left. Throws
/// std::invalid_argument if an option is not valid (naming it) or an end point is not finite.
GAUSSMAP_API WallScore scoreWalls(const SegmentMap& map, const std::vector<Segment>& walls,
                                  const WallScoreOptions& options = {});

}  // namespace gaussmap::detail
