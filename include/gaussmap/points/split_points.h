// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Which part is split next.
enum class SplitRule {
  Distance,  ///< the one whose points are farthest from its mean: every point comes near to some mean
  Shape      ///< the one that is thickest: few parts on planes, many where the surface bends
};

/// The point that stands for a part.
enum class PartPoint {
  Mean,   ///< its mean: nearest to its points, but no point itself
  Sample  ///< its point nearest to the mean
};

struct SplitPointsOptions {
  std::size_t max_parts = 10000;  ///< >= 1
  double max_error = 0.0;         ///< > 0: as few parts as keep 95 % of the points within it [m]; 0: max_parts
  SplitRule rule = SplitRule::Distance;
  PartPoint part_point = PartPoint::Mean;  ///< what distances are measured from
  int rounds = 3;                          ///< of k-means over the points after the splitting, Distance only, >= 0
  int threads = 0;                         ///< 0 = all; never shows in the result
};

/// A partition of n points, parts in the order of their samples.
struct PointParts {
  std::vector<std::uint32_t> labels;   ///< n, part of each point
  std::vector<Gaussian<3>> gaussians;  ///< mean, covariance (divided by n, maybe singular) and number of points
  std::vector<std::uint32_t> samples;  ///< the point of each part nearest to its mean, rising
  double error = 0.0;                  ///< [m], 95 % of the points lie within it of the point of their part; with
                                       ///< SplitRule::Shape of the plane through it
};

/// Parts points from the top: the part of largest error is cut in two through its mean, across its longest axis, until
/// there are enough. The error of a part is its standard deviation (Distance), or that across its plane and a little of
/// the former (Shape), times the fourth root of its number of points: between what serves the mean error of all points
/// and what serves the largest. A few rounds of k-means (Lloyd) then move every point to the nearest mean. Equal points
/// stay together. O(n log(parts)).
/// Points must be finite and fewer than 2^32. Throws std::invalid_argument, naming the option or the point.
GAUSSMAP_API PointParts splitPoints(const std::vector<Vector<3>>& points, const SplitPointsOptions& options = {});

}  // namespace gaussmap
