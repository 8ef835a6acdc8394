// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>

#include "gaussmap/segments/utility.h"
#include "segments/evidence.h"
#include "segments/line_spread.h"

namespace gaussmap::detail {

inline constexpr int kNone = -1;

/// Whether evidence has no direction of its own: by the standard error of the first eigenvector's angle.
inline bool isRound(double n, const LineFit& line) {
  return n < 2.5 || std::sqrt(line.along * line.across / n) > 0.2 * (line.along - line.across);
}

/// How sure a cell with so many observations is to be where they say, in [0, 1).
inline double cellWeight(double n) {
  return n / (n + 1.0);
}

/// A segment while it grows. Coordinates are relative to the origin of the map's sums.
struct LiveSegment {
  bool alive = false;
  SegmentEvidence evidence;
  LineFit line;
  double begin = 0.0, end = 0.0;  ///< extent along the line [m]
  LineMoments total;              ///< of all evidence
  LineMoments shape;              ///< of all cells, each weighted by cellWeight()
  double cells = 0.0;             ///< sum of these weights
  LineSpread spread;
  Vector<2> view{0.0, 0.0};            ///< sum of unit vectors towards the sensors that saw it: its free side
  int next = kNone, previous = kNone;  ///< in the chain
  std::int64_t last_seen = 0;
  BeamSums beams;                 ///< of the scan that is being added
  double decided_at = 0.0;        ///< weight at the last decision ...
  std::size_t decided_cells = 0;  ///< ... and cells of the row

  Vector<2> start() const { return line.center + begin * line.direction; }
  Vector<2> finish() const { return line.center + end * line.direction; }
  double length() const { return end - begin; }
  bool degenerate() const { return isRound(total.n, line); }
  SegmentGoals goals() const;
  /// Squared distance of a point to it [m^2].
  double squaredDistance(const Vector<2>& point) const;
};

/// Direction along a surface that is seen from where `view` points to; `otherwise` if it points nowhere.
inline Vector<2> facing(const Vector<2>& view, const Vector<2>& otherwise) {
  const double length = view.norm();
  return length > 0.0 ? Vector<2>(Vector<2>(view.y(), -view.x()) / length) : otherwise;
}

/// Line, extent and sums from the evidence.
void refit(LiveSegment& segment);

/// The least-squares line, or `like` through the middle of what has no direction of its own.
LineFit fitEvidence(const LineMoments& total, const Vector<2>& like);

/// Its cells [first, last) as a segment, without links.
LiveSegment partOf(const LiveSegment& segment, std::size_t first, std::size_t last);
/// The evidence of both as one segment, without links.
LiveSegment merged(const LiveSegment& a, const LiveSegment& b);

/// The goals of what partOf() and merged() would be.
SegmentGoals goalsOfPart(const LiveSegment& segment, std::size_t first, std::size_t last);
SegmentGoals goalsTogether(const LiveSegment& a, const LiveSegment& b);

/// Where the summed squared error of the two sides is smallest, by prefix sums: the number of cells of the first. 0 if
/// there is none.
std::size_t bestBreak(const CellRow& row);

/// Makes `to` the next of `from` in their chain; what was linked there before is not any more.
void link(int from, int to, std::deque<LiveSegment>& segments);
void unlinkNext(int id, std::deque<LiveSegment>& segments);
/// Takes a segment out of its chain.
void detach(int id, std::deque<LiveSegment>& segments);

}  // namespace gaussmap::detail
