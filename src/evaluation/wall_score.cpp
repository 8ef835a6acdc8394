// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/wall_score.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "core/pi.h"
#include "core/quantile.h"
#include "evaluation/segment_tree.h"

namespace gaussmap::detail {
namespace {

constexpr double kSameWay = 20.0 * kPi / 180.0;
constexpr double kSamePoint = 1e-6;  // [m]

/// Returns the share of the length of `lines` that is within the tolerance of a segment of the tree; 1 without lines.
double shareNear(const std::vector<Segment>& lines, const SegmentTree& tree, const WallScoreOptions& options) {
  double all = 0.0, near = 0.0;
  for (const Segment& line : lines) {
    const double length = line.length(), pieces = std::max(1.0, std::ceil(length / options.spacing));
    for (std::size_t i = 0; i < std::size_t(pieces); ++i) {
      const Vector<2> point = line.start + (double(i) + 0.5) / pieces * (line.end - line.start);
      all += length / pieces;
      if (tree.distance(point) <= options.tolerance) near += length / pieces;
    }
  }
  return all > 0.0 ? near / all : 1.0;
}

double angleBetween(const Vector<2>& from, const Vector<2>& to) {
  return std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
}

/// Returns (offset [m], angle [rad]) of a segment relative to the wall that it represents. Returns std::nullopt if
/// there is no such wall.
std::optional<Vector<2>> errorOf(const Segment& segment, const std::vector<Segment>& walls,
                                 const WallScoreOptions& options) {
  const Vector<2> middle = (segment.start + segment.end) / 2.0;
  const Segment* nearest = nullptr;
  double least = options.tolerance;
  for (const Segment& wall : walls) {
    if (wall.length() < options.shortest) continue;
    if (std::abs(angleBetween(wall.direction(), segment.direction())) > kSameWay) continue;
    const double distance = wall.distance(middle);
    if (distance > least) continue;
    least = distance;
    nearest = &wall;
  }
  if (nearest == nullptr) return std::nullopt;
  return Vector<2>(nearest->normal().dot(middle - nearest->start),
                   angleBetween(nearest->direction(), segment.direction()));
}

void scoreLines(const SegmentMap& map, const std::vector<Segment>& walls, const WallScoreOptions& options,
                WallScore& score) {
  double length = 0.0, normalised = 0.0;
  Vector<2> squares = Vector<2>::Zero();
  for (const Segment& segment : map.segments) {
    const std::optional<Vector<2>> error = errorOf(segment, walls, options);
    if (!error) continue;
    ++score.matched;
    length += segment.length();
    squares += segment.length() * error->cwiseAbs2();
    normalised += error->dot(Matrix<2>(segment.covariance.inverse()) * *error);
  }
  if (score.matched == 0 || !(length > 0.0)) return;
  score.offset_rms = std::sqrt(squares.x() / length);
  score.angle_rms = std::sqrt(squares.y() / length);
  score.normalised_error = normalised / static_cast<double>(score.matched);
}

void scoreCorners(const SegmentMap& map, const std::vector<Segment>& walls, const WallScoreOptions& options,
                  WallScore& score) {
  std::vector<double> distances;
  for (const Segment& wall : walls) {
    for (const Segment& next : walls) {
      if ((next.start - wall.end).norm() > kSamePoint) continue;
      if (std::abs(angleBetween(wall.direction(), next.direction())) * 180.0 / kPi <= options.corner_deg) continue;
      double least = std::numeric_limits<double>::infinity();
      for (const Segment& segment : map.segments)
        least = std::min({least, (segment.start - wall.end).norm(), (segment.end - wall.end).norm()});
      distances.push_back(least);
    }
  }
  score.corners = distances.size();
  if (distances.empty()) return;
  score.corner_median = nthSmallest(distances, distances.size() / 2);
}

}  // namespace

WallScore scoreWalls(const SegmentMap& map, const std::vector<Segment>& walls, const WallScoreOptions& options) {
  require(options.tolerance > 0.0, "tolerance", options.tolerance, "must be positive");
  require(options.spacing > 0.0, "spacing", options.spacing, "must be positive");
  require(options.shortest >= 0.0, "shortest", options.shortest, "must not be negative");
  require(options.corner_deg >= 0.0, "corner_deg", options.corner_deg, "must not be negative");
  WallScore score;
  score.recall = shareNear(walls, SegmentTree(map.segments), options);
  score.precision = shareNear(map.segments, SegmentTree(walls), options);
  scoreLines(map, walls, options, score);
  scoreCorners(map, walls, options, score);
  return score;
}

}  // namespace gaussmap::detail
