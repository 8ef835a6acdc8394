// SPDX-License-Identifier: BSD-3-Clause
#include "segments/output_map.h"

#include <cmath>
#include <optional>
#include <vector>

namespace gaussmap::detail {
namespace {

constexpr double kCorner = 0.17;        // minimum sine of the angle between two linked lines, to join them
constexpr double kUpright = 0.5;        // the same for a segment that ends on a wall
constexpr std::size_t kEndCells = 1;    // cells at each end that are left out of the final line fit ...
constexpr std::size_t kManyCells = 16;  // ... if a segment has at least this many cells
constexpr double kReach = 0.15;         // maximum change of a segment's length to join it [m]

/// Fits the line without the cells at its ends. These cells contain some hits on adjacent surfaces, which would pull
/// the line towards these surfaces.
LiveSegment withoutEnds(LiveSegment live) {
  const std::vector<SegmentCell>& cells = live.evidence.row.cells();
  if (cells.size() < kManyCells) return live;
  LineMoments inner;
  for (std::size_t i = kEndCells; i + kEndCells < cells.size(); ++i) inner += cells[i].hits;
  if (!(inner.n > 0.0)) return live;  // all particles of the middle may have been dropped
  const LineFit line = fitLine(inner, live.line.direction);
  live.spread.shift(live.line.position(line.center));
  const Vector<2> start = live.start(), finish = live.finish();
  live.line = line;
  live.begin = line.position(start);
  live.end = line.position(finish);
  return live;
}

Segment toSegment(const LiveSegment& live, const Vector<2>& origin) {
  Segment segment;
  segment.start = live.start() + origin;
  segment.end = live.finish() + origin;
  segment.normal_variance = live.line.across;
  segment.covariance = live.spread.covariance(live.line);
  // Moves the covariance from the centre of the evidence to the middle of the segment.
  const double by = 0.5 * (live.begin + live.end);
  Matrix<2> shift;
  shift << 1.0, by, 0.0, 1.0;
  segment.covariance = shift * segment.covariance * shift.transpose();
  segment.weight = live.spread.beams();
  segment.last_seen = live.last_seen;
  return segment;
}

/// Moves the end of `first` and the start of `second` to the intersection of their lines. Returns false, and moves
/// nothing, if the intersection is not near both.
bool join(Segment& first, Segment& second) {
  const Vector<2> u = first.direction(), v = second.direction();
  const double sine = u.x() * v.y() - u.y() * v.x();
  if (std::abs(sine) < kCorner) return false;
  const Vector<2> between = second.start - first.start;
  const Vector<2> vertex = first.start + (between.x() * v.y() - between.y() * v.x()) / sine * u;
  if ((vertex - first.end).norm() > kReach || (vertex - second.start).norm() > kReach) return false;
  first.end = vertex;
  second.start = vertex;
  return true;
}

/// Returns the point where the line of `segment` meets `wall` from the wall's free side. Returns std::nullopt if there
/// is no such point near `end`, an end of the segment.
std::optional<Vector<2>> meets(const Segment& segment, const Vector<2>& end, const Segment& wall) {
  const Vector<2> u = segment.direction(), v = wall.direction();
  const double sine = u.x() * v.y() - u.y() * v.x();
  if (std::abs(sine) < kUpright) return {};
  const Vector<2> between = wall.start - end;
  const double along = (between.x() * v.y() - between.y() * v.x()) / sine;
  if (std::abs(along) > kReach) return {};
  const Vector<2> vertex = end + along * u;
  const double position = v.dot(vertex - wall.start);
  if (position < -kReach || position > wall.length() + kReach) return {};
  const Vector<2> middle = 0.5 * (segment.start + segment.end);
  if (wall.normal().dot(middle - vertex) <= 0.0) return {};
  return vertex;
}

/// Moves free ends onto the line of another segment if they nearly reach it.
void touchWalls(const std::vector<bool>& free_start, const std::vector<bool>& free_end,
                std::vector<Segment>& segments) {
  const std::vector<Segment> walls = segments;
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (const bool at_end : {false, true}) {
      if (!(at_end ? free_end[i] : free_start[i])) continue;
      const Vector<2> end = at_end ? walls[i].end : walls[i].start;
      std::optional<Vector<2>> best;
      for (std::size_t k = 0; k < walls.size(); ++k) {
        if (k == i) continue;
        const std::optional<Vector<2>> vertex = meets(walls[i], end, walls[k]);
        if (vertex && (!best || (*vertex - end).norm() < (*best - end).norm())) best = vertex;
      }
      if (best) (at_end ? segments[i].end : segments[i].start) = *best;
    }
}

}  // namespace

SegmentMap outputMap(const std::deque<LiveSegment>& live, const Vector<2>& origin, bool adjust_ends) {
  SegmentMap map;
  std::vector<bool> done(live.size(), false);
  std::vector<bool> free_start, free_end;
  const auto walk = [&](int from, bool closed) {
    SegmentMap::Chain chain;
    chain.first = map.segments.size();
    for (int id = from; id != kNone && !done[id]; id = live[id].next) {
      done[id] = true;
      map.segments.push_back(toSegment(adjust_ends ? withoutEnds(live[id]) : live[id], origin));
    }
    free_start.resize(map.segments.size(), true);
    free_end.resize(map.segments.size(), true);
    chain.last = map.segments.size();
    chain.closed = closed;
    const auto joinEnds = [&](std::size_t i, std::size_t k) {
      if (join(map.segments[i], map.segments[k])) free_end[i] = free_start[k] = false;
    };
    for (std::size_t i = chain.first; i + 1 < chain.last; ++i) joinEnds(i, i + 1);
    if (closed && chain.last - chain.first > 1) joinEnds(chain.last - 1, chain.first);
    map.chains.push_back(chain);
  };
  for (int id = 0; id < static_cast<int>(live.size()); ++id)
    if (live[id].alive && live[id].previous == kNone) walk(id, false);
  for (int id = 0; id < static_cast<int>(live.size()); ++id)  // the remaining chains are closed
    if (live[id].alive && !done[id]) walk(id, true);
  if (adjust_ends) touchWalls(free_start, free_end, map.segments);
  return map;
}

}  // namespace gaussmap::detail
