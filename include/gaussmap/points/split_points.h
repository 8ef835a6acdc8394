// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Decides which part of the points is split next.
enum class SplitRule {
  Distance,  ///< the part with the largest distances from its mean: every point gets a mean nearby
  Shape      ///< the part that is least flat: few parts on planes, many where the surface is curved
};

/// The point that represents a part.
enum class PartPoint {
  Mean,   ///< the mean of the part: close to its points, but not one of them
  Sample  ///< the point of the part nearest to its mean
};

/// Options of splitPoints().
struct SplitPointsOptions {
  std::size_t max_parts = 10000;  ///< maximum number of parts, >= 1
  /// If > 0: PointParts::error must not exceed this distance [m]. The function makes as few parts as possible for this,
  /// but at most max_parts. If 0: it makes max_parts parts, or fewer if equal points leave nothing to split.
  double max_error = 0.0;
  SplitRule rule = SplitRule::Distance;    ///< which part is split next
  PartPoint part_point = PartPoint::Mean;  ///< PointParts::error is the distance from this point of a part
  int rounds = 3;                          ///< maximum rounds of k-means, SplitRule::Distance only, >= 0
  int threads = 0;                         ///< 0 = all cores
};

/// A partition of points into parts. The parts are in the order of `samples`.
struct PointParts {
  std::vector<std::uint32_t> labels;  ///< per point: its part
  /// Per part: mean, covariance and number of points. The covariance is divided by this number; it can be singular.
  std::vector<Gaussian<3>> gaussians;
  std::vector<std::uint32_t> samples;  ///< per part: index of the point nearest to its mean, ascending
  /// 95 % of the points are at most this far from the point of their part [m], see SplitPointsOptions::part_point. With
  /// SplitRule::Shape, it is the distance from the plane of the part through this point.
  double error = 0.0;
};

/// Splits points into parts, top-down: the part of largest error is cut in two through its mean, across its longest
/// axis. This repeats until there are enough parts.
///
/// With SplitRule::Distance, the error of a part is its standard deviation. With SplitRule::Shape, it is the standard
/// deviation across the plane of the part, plus a small share of the total standard deviation. Both are multiplied by
/// the fourth root of the number of points, a compromise between a small mean error and a small maximum error. With
/// SplitRule::Distance, a few rounds of k-means (Lloyd) then move every point to the part of the nearest mean. Their
/// result is not used if its PointParts::error is above both the previous one and max_error. Equal points stay in the
/// same part. The cost is O(n log(parts)).
///
/// Throws std::invalid_argument if an option is out of range or a point is not finite; the message gives the option or
/// the point. There must be fewer than 2^32 points.
GAUSSMAP_API PointParts splitPoints(const std::vector<Vector<3>>& points, const SplitPointsOptions& options = {});

}  // namespace gaussmap
