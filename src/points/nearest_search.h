// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "gaussmap/version.h"
#include "points/point_tree.h"

namespace gaussmap::detail {

/// The trees of two sets of points, built at the same time.
class GAUSSMAP_API PointTreePair {
 public:
  PointTreePair(const std::vector<Vector<3>>& a, const std::vector<Vector<3>>& b, int threads);
  const PointTree& a() const { return *trees_[0]; }
  const PointTree& b() const { return *trees_[1]; }

 private:
  std::unique_ptr<PointTree> trees_[2];
};

/// Returns per point of `from` the distance to the nearest point of `to` [m], in the original order of the points.
/// Neither tree may be empty. `threads`: 0 = all cores. `comparisons`, if given, gets the number of point pairs that
/// were compared, which takes most of the time.
GAUSSMAP_API std::vector<double> nearestDistances(const PointTree& from, const PointTree& to, int threads,
                                                  std::size_t* comparisons = nullptr);

/// Returns the largest of these distances [m], bit-identical, without computing all of them. Here `comparisons` depends
/// on the number of threads.
GAUSSMAP_API double largestNearestDistance(const PointTree& from, const PointTree& to, int threads,
                                           std::size_t* comparisons = nullptr);

}  // namespace gaussmap::detail
