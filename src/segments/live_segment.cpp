// SPDX-License-Identifier: BSD-3-Clause
#include "segments/live_segment.h"

#include <cmath>
#include <limits>

namespace gaussmap::detail {
namespace {

constexpr double kTurn = 0.1;      // sine of the angle between line and row above which the cells are rebuilt
constexpr double kNothing = 1e-9;  // a smaller weight is zero with a rounding error
constexpr double kSpill = 0.2;     // minimum share that a cell at an end has of its neighbour's weight

/// Sums over cells, and their extent along a line.
struct RowShape {
  LineMoments moments;  // each cell scaled to the weight cellWeight()
  double cells = 0.0;   // sum of these weights
  double begin = std::numeric_limits<double>::infinity(), end = -begin;
};

RowShape shapeOf(const CellRow& row, std::size_t first, std::size_t last, const LineFit& line) {
  RowShape shape;
  const std::vector<SegmentCell>& cells = row.cells();
  for (std::size_t i = first; i < last; ++i) {
    const LineMoments& hits = cells[i].hits;
    if (hits.n <= 0.0) continue;
    const double weight = cellWeight(hits.n);
    shape.moments += weight / hits.n * hits;
    shape.cells += weight;
    // Noise puts a few hits into the cell after an end. They do not extend the segment.
    if (i == first && i + 1 < last && kSpill * cells[i + 1].hits.n > hits.n) continue;
    if (i + 1 == last && i > first && kSpill * cells[i - 1].hits.n > hits.n) continue;
    // A uniform distribution over [a, b] has mean (a + b) / 2 and variance (b - a)^2 / 12.
    const double t = line.position(hits.mean()),
                 half = std::min(std::sqrt(3.0 * hits.variance(line.direction)), 0.5 * row.size());
    shape.begin = std::min(shape.begin, t - half);
    shape.end = std::max(shape.end, t + half);
  }
  return shape;
}

}  // namespace

SegmentGoals LiveSegment::goals() const {
  SegmentGoals goals;
  goals.normal_variance = line.across;
  goals.length = length();
  goals.weight = total.n;
  goals.cells = cells;
  goals.misfit = squaredError(shape);
  goals.start = start();
  goals.end = finish();
  return goals;
}

double LiveSegment::squaredDistance(const Vector<2>& point) const {
  const double t = line.position(point), over = t < begin ? begin - t : t > end ? t - end : 0.0, d = line.offset(point);
  return d * d + over * over;
}

LineFit fitEvidence(const LineMoments& total, const Vector<2>& like) {
  LineFit fit = fitLine(total, like);
  if (!isRound(total.n, fit)) return fit;
  fit.direction = like;
  fit.along = total.variance(fit.direction);
  fit.across = total.variance(fit.normal());
  return fit;
}

void refit(LiveSegment& segment) {
  CellRow& row = segment.evidence.row;
  segment.total = row.total();
  const LineFit before = segment.line;
  segment.line = fitEvidence(segment.total, facing(segment.view, before.direction));
  const Vector<2>& direction = segment.line.direction;
  segment.spread.shift(before.position(segment.line.center));
  if (before.direction.dot(direction) < 0.0) segment.spread.turn();
  const Vector<2>& axis = row.axis();
  if (std::abs(axis.x() * direction.y() - axis.y() * direction.x()) > kTurn || axis.dot(direction) < 0.0)
    row = row.turned(row.origin(), direction);
  const RowShape shape = shapeOf(row, 0, row.cells().size(), segment.line);
  segment.shape = shape.moments;
  segment.cells = shape.cells;
  segment.begin = shape.begin;
  segment.end = shape.end;
}

LiveSegment partOf(const LiveSegment& segment, std::size_t first, std::size_t last) {
  LiveSegment part;
  part.alive = true;
  part.evidence = segment.evidence.slice(first, last);
  part.line = segment.line;
  const double share = part.evidence.row.total().n / segment.total.n;
  part.spread = segment.spread.part(share);
  part.view = share * segment.view;
  part.last_seen = segment.last_seen;
  refit(part);
  return part;
}

LiveSegment merged(const LiveSegment& a, const LiveSegment& b) {
  // Uses the row of the longer segment. On the row of a short segment, the cells of a long one could coincide.
  const LiveSegment &longer = a.length() >= b.length() ? a : b, &shorter = a.length() >= b.length() ? b : a;
  LiveSegment both;
  both.alive = true;
  both.evidence = longer.evidence;
  both.evidence.absorb(shorter.evidence);
  both.line = longer.line;
  both.spread = longer.spread;
  LineSpread spread = shorter.spread;
  spread.shift(shorter.line.position(longer.line.center));
  if (longer.line.direction.dot(shorter.line.direction) < 0.0) spread.turn();
  both.spread.absorb(spread);
  both.view = a.view + b.view;
  both.last_seen = std::max(a.last_seen, b.last_seen);
  refit(both);
  return both;
}

SegmentGoals goalsOfPart(const LiveSegment& segment, std::size_t first, std::size_t last) {
  LiveSegment part;
  for (std::size_t i = first; i < last; ++i) part.total += segment.evidence.row.cells()[i].hits;
  part.line = fitEvidence(part.total, segment.line.direction);
  const RowShape shape = shapeOf(segment.evidence.row, first, last, part.line);
  part.shape = shape.moments;
  part.cells = shape.cells;
  part.begin = shape.begin;
  part.end = shape.end;
  return part.goals();
}

SegmentGoals goalsTogether(const LiveSegment& a, const LiveSegment& b) {
  LiveSegment both;
  both.total = a.total + b.total;
  both.shape = a.shape + b.shape;
  both.cells = a.cells + b.cells;
  both.line = fitEvidence(both.total, a.line.direction);
  const double ends[] = {both.line.position(a.start()), both.line.position(a.finish()), both.line.position(b.start()),
                         both.line.position(b.finish())};
  both.begin = *std::min_element(ends, ends + 4);
  both.end = *std::max_element(ends, ends + 4);
  return both.goals();
}

std::size_t bestBreak(const CellRow& row) {
  const auto weighted = [](const SegmentCell& cell) {
    return cell.hits.n > 0.0 ? cellWeight(cell.hits.n) / cell.hits.n * cell.hits : LineMoments();
  };
  const std::vector<SegmentCell>& cells = row.cells();
  LineMoments left, right;
  for (const SegmentCell& cell : cells) right += weighted(cell);
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
    if (cells[i].hits.n <= 0.0) continue;
    const LineMoments own = weighted(cells[i]);
    left += own;
    right = right - own;
    if (right.n < kNothing) break;
    const double error = squaredError(left) + squaredError(right);
    if (error < least) {
      least = error;
      best = i + 1;
    }
  }
  return best;
}

void link(int from, int to, std::deque<LiveSegment>& segments) {
  if (segments[from].next == to) return;
  unlinkNext(from, segments);
  if (segments[to].previous != kNone) unlinkNext(segments[to].previous, segments);
  segments[from].next = to;
  segments[to].previous = from;
}

void unlinkNext(int id, std::deque<LiveSegment>& segments) {
  int& next = segments[id].next;
  if (next == kNone) return;
  segments[next].previous = kNone;
  next = kNone;
}

void detach(int id, std::deque<LiveSegment>& segments) {
  unlinkNext(id, segments);
  if (segments[id].previous != kNone) unlinkNext(segments[id].previous, segments);
}

}  // namespace gaussmap::detail
