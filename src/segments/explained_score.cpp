// SPDX-License-Identifier: BSD-3-Clause
#include "segments/explained_score.h"

#include <algorithm>
#include <limits>

namespace gaussmap::detail {

double ExplainedScore::explained(const LineMoments& hits, const LineFit& line) const {
  const double ratio = hits.squaredDistance(line.center, line.normal()) / (tolerance * tolerance);
  return ratio < 1.0 ? hits.n * (1.0 - ratio * ratio * ratio) : 0.0;
}

double ExplainedScore::costOfCell(const std::vector<SegmentCell>& cells, std::size_t i) const {
  // A single empty cell is not a hole: when evidence moves to another row, the neighbours may get a cell's hits.
  const auto empty = [&](std::size_t k) { return k < cells.size() && cells[k].hits.n <= 0.0; };
  const bool hole = empty(i) && ((i > 0 && empty(i - 1)) || empty(i + 1));
  return cell_cost + crossing_cost * cells[i].crossed + (hole ? hole_cost : 0.0);
}

double ExplainedScore::costOf(const std::vector<SegmentCell>& cells) const {
  double sum = segment_cost;
  for (std::size_t i = 0; i < cells.size(); ++i) sum += costOfCell(cells, i);
  return sum;
}

double ExplainedScore::scoreOf(const LiveSegment& segment) const {
  const std::vector<SegmentCell>& cells = segment.evidence.row.cells();
  double sum = -costOf(cells);
  for (const SegmentCell& cell : cells)
    if (cell.hits.n > 0.0) sum += explained(cell.hits, segment.line);
  return sum;
}

std::vector<ScoredRange> bestRanges(const CellRow& row, const LineFit& line, const ExplainedScore& score) {
  const std::vector<SegmentCell>& cells = row.cells();
  // For the cells before number i: best[i] is the highest score of all choices, kept[i] the highest score of the
  // choices that keep cell i - 1. In the latter, begun[i] is the first cell of the range that contains cell i - 1.
  std::vector<double> best(cells.size() + 1, 0.0), kept(cells.size() + 1, -std::numeric_limits<double>::infinity());
  std::vector<std::size_t> begun(cells.size() + 1, 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double own = -score.costOfCell(cells, i);
    if (cells[i].hits.n > 0.0) own += score.explained(cells[i].hits, line);
    const double fresh = best[i] - score.segment_cost;
    begun[i + 1] = kept[i] >= fresh ? begun[i] : i;
    kept[i + 1] = std::max(kept[i], fresh) + own;
    best[i + 1] = std::max(best[i], kept[i + 1]);
  }
  std::vector<ScoredRange> ranges;
  for (std::size_t i = cells.size(); i > 0;) {
    if (best[i] > best[i - 1]) {
      ranges.push_back({begun[i], i, best[i] - best[begun[i]]});
      i = begun[i];
    } else {
      --i;
    }
  }
  std::reverse(ranges.begin(), ranges.end());
  return ranges;
}

}  // namespace gaussmap::detail
