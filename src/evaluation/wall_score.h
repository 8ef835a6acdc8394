// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "gaussmap/segments/segment_map.h"

namespace gaussmap::detail {

struct WallScoreOptions {
  double tolerance = 0.05;   ///< how near a wall and a segment must be to be found, or right [m], > 0
  double spacing = 0.01;     ///< of the samples on walls and segments [m], > 0
  double shortest = 0.5;     ///< walls shorter than this tell nothing about offsets and angles [m], >= 0
  double corner_deg = 30.0;  ///< corners are where walls meet that turn by more than this [degree]
};

/// How a map of segments differs from the true walls.
struct WallScore {
  double recall = 0.0;     ///< share of the walls' length within the tolerance of a segment; 1 without walls
  double precision = 0.0;  ///< share of the segments' length within the tolerance of a wall; 1 without segments
  /// Segments whose middle lies within the tolerance of a long enough wall that looks the same way (within 20 degrees),
  /// each compared with the nearest such wall.
  std::size_t matched = 0;
  double offset_rms = 0.0;  ///< of their middles from the walls' lines, weighted by length [m]
  double angle_rms = 0.0;   ///< of their directions, weighted by length [rad]
  /// Mean of e' C^-1 e over them, with e = (offset, angle) and C = Segment::covariance; 2 if the covariances are right.
  double normalised_error = 0.0;
  std::size_t corners = 0;     ///< of the walls
  double corner_median = 0.0;  ///< of their distances to the nearest end point of a segment [m]; infinity if none
};

/// `walls` need start and end only, free space on their left. Throws std::invalid_argument, naming the option, or if
/// an end point is not finite.
WallScore scoreWalls(const SegmentMap& map, const std::vector<Segment>& walls, const WallScoreOptions& options = {});

}  // namespace gaussmap::detail
