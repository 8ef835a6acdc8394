// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "segments/live_segment.h"

namespace gaussmap::detail {

/// The score of a segment: the observations that it explains minus its cost. The unit of both is observations.
struct ExplainedScore {
  double tolerance = 0.1;      ///< an observation counts 1 on the line, and 0 at this distance from it [m]
  double segment_cost = 0.0;   ///< per segment
  double cell_cost = 0.0;      ///< per cell of its length
  double hole_cost = 0.0;      ///< additional cost per empty cell next to an empty cell
  double crossing_cost = 0.0;  ///< per ray that passed through it

  /// Returns how many observations of a cell a line explains. Unlike a squared distance, the function is flat near the
  /// line: a wall that is off by a third of the tolerance is explained as well as one on the line.
  double explained(const LineMoments& hits, const LineFit& line) const;
  double costOfCell(const std::vector<SegmentCell>& cells, std::size_t i) const;
  /// Returns the cost of a segment with these cells.
  double costOf(const std::vector<SegmentCell>& cells) const;
  double scoreOf(const LiveSegment& segment) const;
};

/// Cells [first, last) of a row.
struct ScoredRange {
  std::size_t first = 0;
  std::size_t last = 0;
  double score = 0.0;  ///< of these cells as a segment
};

/// Returns the ranges of cells of a row whose scores as segments on a line have the highest sum, in order. The result
/// is exact (dynamic programming).
std::vector<ScoredRange> bestRanges(const CellRow& row, const LineFit& line, const ExplainedScore& score);

}  // namespace gaussmap::detail
