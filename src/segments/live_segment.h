// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>

#include "gaussmap/segments/utility.h"
#include "segments/evidence.h"
#include "segments/line_spread.h"

namespace gaussmap::detail {

inline constexpr int kNone = -1;

/// Returns true if evidence has no clear direction: if the first eigenvector's angle has a large standard error.
inline bool isRound(double n, const LineFit& line) {
  return n < 2.5 || std::sqrt(line.along * line.across / n) > 0.2 * (line.along - line.across);
}

/// Returns the confidence in the position of a cell with `n` observations, in [0, 1).
inline double cellWeight(double n) {
  return n / (n + 1.0);
}

/// A segment of the map that a SegmentFitter builds. Coordinates are relative to SegmentVotes::origin().
struct LiveSegment {
  bool alive = false;
  SegmentEvidence evidence;
  LineFit line;
  double begin = 0.0, end = 0.0;  ///< extent along the line [m]
  LineMoments total;              ///< of all evidence
  LineMoments shape;              ///< of all cells, each scaled to the weight cellWeight()
  double cells = 0.0;             ///< sum of these weights
  LineSpread spread;
  Vector<2> view{0.0, 0.0};            ///< sum of unit vectors from hits to sensors, points to its free side
  int next = kNone, previous = kNone;  ///< segments in the chain
  std::int64_t last_seen = 0;
  BeamSums beams;                 ///< of the scan that is being added
  double decided_at = 0.0;        ///< weight at the last decision
  std::size_t decided_cells = 0;  ///< length of the row at the last decision

  Vector<2> start() const { return line.center + begin * line.direction; }
  Vector<2> finish() const { return line.center + end * line.direction; }
  double length() const { return end - begin; }
  bool degenerate() const { return isRound(total.n, line); }
  SegmentGoals goals() const;
  /// Returns the squared distance of a point to the segment [m^2].
  double squaredDistance(const Vector<2>& point) const;
};

/// Returns the direction of a surface whose free side `view` points to; `otherwise` if `view` is zero.
inline Vector<2> facing(const Vector<2>& view, const Vector<2>& otherwise) {
  const double length = view.norm();
  return length > 0.0 ? Vector<2>(Vector<2>(view.y(), -view.x()) / length) : otherwise;
}

/// Computes the line, the extent and the sums from the evidence.
void refit(LiveSegment& segment);

/// Returns the least-squares line. If the evidence has no clear direction, the line has the direction `like`.
LineFit fitEvidence(const LineMoments& total, const Vector<2>& like);

/// Returns the cells [first, last) of a segment as a segment without links.
LiveSegment partOf(const LiveSegment& segment, std::size_t first, std::size_t last);
/// Returns the evidence of both as one segment without links.
LiveSegment merged(const LiveSegment& a, const LiveSegment& b);

/// Return the goals that the results of partOf() and merged() would have, without building them.
SegmentGoals goalsOfPart(const LiveSegment& segment, std::size_t first, std::size_t last);
SegmentGoals goalsTogether(const LiveSegment& a, const LiveSegment& b);

/// Returns the number of cells before the best break point, where the summed squared error of both sides is smallest.
/// Returns 0 if there is no break point.
std::size_t bestBreak(const CellRow& row);

/// Makes `to` the successor of `from` in their chain. Removes the link after `from` and the link before `to`, if any.
void link(int from, int to, std::deque<LiveSegment>& segments);
void unlinkNext(int id, std::deque<LiveSegment>& segments);
/// Removes a segment from its chain.
void detach(int id, std::deque<LiveSegment>& segments);

}  // namespace gaussmap::detail
