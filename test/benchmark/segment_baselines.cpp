// SPDX-License-Identifier: BSD-3-Clause
#include "segment_baselines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::benchmark {
namespace {

double cross(const Vector<2>& a, const Vector<2>& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Sums of points and of their products.
struct Sums {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;

  void add(const Vector<2>& p) {
    n += 1.0;
    x += p.x();
    y += p.y();
    xx += p.x() * p.x();
    xy += p.x() * p.y();
    yy += p.y() * p.y();
  }
  void add(const Sums& other) {
    n += other.n;
    x += other.x;
    y += other.y;
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
  }
};

struct Line {
  Vector<2> mean{0.0, 0.0}, direction{1.0, 0.0};
  double offset(const Vector<2>& point) const { return cross(direction, point - mean); }
  double along(const Vector<2>& point) const { return direction.dot(point - mean); }
};

/// Fits a line by total least squares. Its direction is turned to agree with `like`.
Line fit(const Sums& sums, const Vector<2>& like) {
  const double mx = sums.x / sums.n, my = sums.y / sums.n;
  const double xx = sums.xx / sums.n - mx * mx, xy = sums.xy / sums.n - mx * my, yy = sums.yy / sums.n - my * my;
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  Line line{{mx, my}, {std::cos(angle), std::sin(angle)}};
  if (line.direction.dot(like) < 0.0) line.direction = -line.direction;
  return line;
}

/// Points that the method assigns to one straight wall.
struct Piece {
  Sums sums;
  Line line;
  double first = 0.0, last = 0.0;  // along the line

  Vector<2> start() const { return line.mean + first * line.direction; }
  Vector<2> end() const { return line.mean + last * line.direction; }
};

void findPieces(const std::vector<Vector<2>>& points, std::size_t first, std::size_t last, const Vector<2>& sensor,
                const EndPointFitOptions& options, std::vector<Piece>& pieces) {
  if (last - first < options.points) return;
  const Vector<2> chord = (points[last - 1] - points[first]).normalized();
  double most = options.threshold;
  std::size_t at = last;
  for (std::size_t i = first; i < last; ++i) {
    const double distance = std::abs(cross(chord, points[i] - points[first]));
    if (distance > most) {
      most = distance;
      at = i;
    }
  }
  if (at < last) {  // the point at the break can belong to either side, so it is left out
    findPieces(points, first, at, sensor, options, pieces);
    findPieces(points, at + 1, last, sensor, options, pieces);
    return;
  }
  Piece piece;
  for (std::size_t i = first; i < last; ++i) piece.sums.add(points[i]);
  piece.line = fit(piece.sums, chord);
  if (piece.line.offset(sensor) < 0.0) piece.line.direction = -piece.line.direction;
  const double a = piece.line.along(points[first]), b = piece.line.along(points[last - 1]);
  piece.first = std::min(a, b);
  piece.last = std::max(a, b);
  pieces.push_back(piece);
}

std::vector<Piece> piecesOf(const LaserScan& scan, const EndPointFitOptions& options) {
  std::vector<Piece> pieces;
  std::vector<Vector<2>> run;
  const auto close = [&] {
    findPieces(run, 0, run.size(), scan.pose.translation, options, pieces);
    run.clear();
  };
  for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam) {
    if (!scan.returned(beam)) {
      close();
      continue;
    }
    const Vector<2> hit = scan.hit(beam);
    if (!run.empty() && (hit - run.back()).norm() > options.gap) close();
    run.push_back(hit);
  }
  close();
  return pieces;
}

/// Returns the distance between two pieces of one wall; std::nullopt if they belong to different walls.
std::optional<double> distanceBetween(const Piece& a, const Piece& b, const EndPointFitOptions& options) {
  if (a.line.direction.dot(b.line.direction) < std::cos(options.merge_deg * std::acos(-1.0) / 180.0))
    return std::nullopt;
  const Vector<2> start = b.start(), end = b.end();
  const double from = a.line.along(start), to = a.line.along(end);
  if (std::max(from, to) < a.first - options.merge_gap || std::min(from, to) > a.last + options.merge_gap)
    return std::nullopt;
  const double distance = std::max(std::abs(a.line.offset(start)), std::abs(a.line.offset(end)));
  if (distance > options.merge) return std::nullopt;
  return distance;
}

void takeIn(Piece& whole, const Piece& part) {
  const std::array<Vector<2>, 4> ends = {whole.start(), whole.end(), part.start(), part.end()};
  whole.sums.add(part.sums);
  whole.line = fit(whole.sums, whole.line.direction);
  whole.first = std::numeric_limits<double>::infinity();
  whole.last = -whole.first;
  for (const Vector<2>& end : ends) {
    whole.first = std::min(whole.first, whole.line.along(end));
    whole.last = std::max(whole.last, whole.line.along(end));
  }
}

/// Returns the nearest piece of `map`, except number `self`, that can be merged with `piece`; map.size() if no piece
/// can. The longer piece takes the shorter one.
std::size_t bestFor(const Piece& piece, const std::vector<Piece>& map, std::size_t self,
                    const EndPointFitOptions& options) {
  std::size_t best = map.size();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (i == self) continue;
    const bool longer = map[i].last - map[i].first >= piece.last - piece.first;
    const auto distance = longer ? distanceBetween(map[i], piece, options) : distanceBetween(piece, map[i], options);
    if (!distance || *distance >= least) continue;
    least = *distance;
    best = i;
  }
  return best;
}

void mergeAll(std::vector<Piece>& map, const EndPointFitOptions& options) {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < map.size();) {
      const std::size_t j = bestFor(map[i], map, i, options);
      if (j == map.size()) {
        ++i;
        continue;
      }
      takeIn(map[std::min(i, j)], map[std::max(i, j)]);
      map.erase(map.begin() + static_cast<std::ptrdiff_t>(std::max(i, j)));
      changed = true;
    }
  }
}

SegmentMap toMap(std::vector<Piece> pieces, std::size_t most) {
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) { return a.sums.n > b.sums.n; });
  pieces.resize(std::min(pieces.size(), most));
  SegmentMap map;
  for (const Piece& piece : pieces) {
    Segment segment;
    segment.start = piece.start();
    segment.end = piece.end();
    segment.weight = piece.sums.n;
    segment.covariance = Matrix<2>::Identity();  // the method estimates no covariance
    map.chains.push_back({map.segments.size(), map.segments.size() + 1, false});
    map.segments.push_back(segment);
  }
  return map;
}

/// Moves an end and the start that is nearest to it to the intersection of their lines, if this is near both.
void joinCorners(SegmentMap& map, double reach) {
  for (Segment& from : map.segments) {
    Segment* nearest = nullptr;
    for (Segment& to : map.segments)
      if (&to != &from && (to.start - from.end).norm() < reach &&
          (nearest == nullptr || (to.start - from.end).norm() < (nearest->start - from.end).norm()))
        nearest = &to;
    if (nearest == nullptr) continue;
    const double sine = cross(from.direction(), nearest->direction());
    if (std::abs(sine) < 0.35) continue;  // 20 degrees
    const double along = cross(nearest->start - from.start, nearest->direction()) / sine;
    const Vector<2> corner = from.start + along * from.direction();
    if ((corner - from.end).norm() > reach || (corner - nearest->start).norm() > reach) continue;
    from.end = nearest->start = corner;
  }
}

}  // namespace

SegmentMap endPointFit(const std::vector<LaserScan>& scans, std::size_t most, const EndPointFitOptions& options) {
  std::vector<Piece> map;
  for (const LaserScan& scan : scans) {
    for (const Piece& piece : piecesOf(scan, options)) {
      const std::size_t best = bestFor(piece, map, map.size(), options);
      if (best == map.size()) {
        map.push_back(piece);
      } else {
        takeIn(map[best], piece);
      }
    }
  }
  mergeAll(map, options);
  SegmentMap result = toMap(std::move(map), most);
  joinCorners(result, options.merge_gap);
  return result;
}

namespace {

/// The points near a line, around the point by which it was found, up to the first gaps.
struct Support {
  double first = 0.0, last = 0.0;  // along the line
  std::size_t points = 0;
};

constexpr double kBin = 0.1, kReach = 40.0;  // along a line, from the point by which it was found [m]
constexpr int kBins = static_cast<int>(2.0 * kReach / kBin);

Support supportOf(const Line& line, const std::vector<Vector<2>>& points, const RansacOptions& options) {
  std::array<std::size_t, kBins> counts{};
  for (const Vector<2>& point : points) {
    if (std::abs(line.offset(point)) > options.inlier) continue;
    const double along = line.along(point);
    if (std::abs(along) < kReach) ++counts[static_cast<std::size_t>((along + kReach) / kBin)];
  }
  Support support;
  support.points = counts[kBins / 2];
  const int gap = static_cast<int>(std::ceil(options.gap / kBin));
  const auto walk = [&](int step) {
    int reached = kBins / 2;
    for (int i = reached + step; i >= 0 && i < kBins && std::abs(i - reached) <= gap; i += step) {
      if (counts[static_cast<std::size_t>(i)] == 0) continue;
      support.points += counts[static_cast<std::size_t>(i)];
      reached = i;
    }
    return reached;
  };
  support.first = walk(-1) * kBin - kReach;
  support.last = (walk(1) + 1) * kBin - kReach;
  return support;
}

}  // namespace

SegmentMap ransac(const std::vector<LaserScan>& scans, std::size_t most, const RansacOptions& options) {
  std::vector<Vector<2>> points;
  for (const LaserScan& scan : scans)
    for (std::size_t beam = 0; beam < scan.ranges.size(); ++beam)
      if (scan.returned(beam)) points.push_back(scan.hit(beam));
  Random random(options.seed);
  std::vector<Piece> pieces;
  while (pieces.size() < most && points.size() > 2) {
    Line best_line;
    Support best;
    for (int trial = 0; trial < options.trials; ++trial) {
      const Vector<2> from = points[random.below(points.size())];
      Vector<2> way = Vector<2>::Zero();
      for (int draw = 0; draw < 50 && !(way.norm() > 0.2 && way.norm() < 3.0); ++draw)
        way = points[random.below(points.size())] - from;
      if (!(way.norm() > 0.0)) continue;
      const Line line{from, way.normalized()};
      const Support support = supportOf(line, points, options);
      if (support.points <= best.points) continue;
      best = support;
      best_line = line;
    }
    if (best.points < 2) break;
    const auto isInlier = [&](const Vector<2>& point) {
      const double along = best_line.along(point);
      return std::abs(best_line.offset(point)) <= options.inlier && along >= best.first && along <= best.last;
    };
    Piece piece;
    for (const Vector<2>& point : points)
      if (isInlier(point)) piece.sums.add(point);
    piece.line = fit(piece.sums, best_line.direction);
    piece.first = std::numeric_limits<double>::infinity();
    piece.last = -piece.first;
    for (const Vector<2>& point : points) {
      if (!isInlier(point)) continue;
      piece.first = std::min(piece.first, piece.line.along(point));
      piece.last = std::max(piece.last, piece.line.along(point));
    }
    points.erase(std::remove_if(points.begin(), points.end(), isInlier), points.end());
    pieces.push_back(piece);
  }
  return toMap(std::move(pieces), most);
}

}  // namespace gaussmap::benchmark
