// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "segments/live_segment.h"

namespace gaussmap::detail {

/// The score of a segment: the observations that it explains less what it costs, also in observations.
struct ExplainedScore {
  double tolerance = 0.1;      ///< an observation on the line counts 1, one at this distance from it 0 [m]
  double segment_cost = 0.0;   ///< per segment
  double cell_cost = 0.0;      ///< per cell of its length
  double hole_cost = 0.0;      ///< in addition, per empty cell beside an empty one
  double crossing_cost = 0.0;  ///< per ray that passed through

  /// Observations of a cell that a line explains. Flat near the line, unlike a squared distance: a wall that is off by
  /// a third of the tolerance is explained as well as one that is not.
  double explained(const LineMoments& hits, const LineFit& line) const;
  double costOfCell(const std::vector<SegmentCell>& cells, std::size_t i) const;
  /// The cost of a segment with these cells.
  double costOf(const std::vector<SegmentCell>& cells) const;
  double scoreOf(const LiveSegment& segment) const;
};

/// Cells [first, last) of a row.
struct ScoredRange {
  std::size_t first = 0;
  std::size_t last = 0;
  double score = 0.0;  ///< as a segment
};

/// The ranges of cells of a row whose scores as segments on a line have the highest sum, in order. Exact, by dynamic
/// programming.
std::vector<ScoredRange> bestRanges(const CellRow& row, const LineFit& line, const ExplainedScore& score);

}  // namespace gaussmap::detail
