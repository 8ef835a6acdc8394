// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "segments/live_segment.h"

namespace gaussmap::detail {

/// What a segment is good for, in observations.
struct Worth {
  double tolerance = 0.1;      ///< an observation on the line counts 1, one this far from it 0 [m]
  double segment_cost = 0.0;   ///< of a segment
  double cell_cost = 0.0;      ///< of a cell's length
  double hole_cost = 0.0;      ///< on top, of an empty cell beside an empty one
  double crossing_cost = 0.0;  ///< of a ray that went through

  /// What a line explains of a cell's observations. Flat within the tolerance, unlike a squared distance: a wall that
  /// is off by a third of it is as well explained as one that is not.
  double explained(const LineMoments& hits, const LineFit& line) const;
  /// What cell `i` of a row costs.
  double costOfCell(const std::vector<SegmentCell>& cells, std::size_t i) const;
  /// What a segment with these cells costs.
  double costOf(const std::vector<SegmentCell>& cells) const;
  /// What a segment explains less what it costs.
  double of(const LiveSegment& segment) const;
};

/// Cells [first, last) of a row.
struct CellRange {
  std::size_t first = 0;
  std::size_t last = 0;
  double worth = 0.0;  ///< as a segment
};

/// The stretches of a row that together are worth most as segments on a line, in order: exact, by dynamic programming.
std::vector<CellRange> worthKeeping(const CellRow& row, const LineFit& line, const Worth& worth);

}  // namespace gaussmap::detail
