// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "points/point_tree.h"

namespace gaussmap::detail {

/// The trees of two sets of points, built at the same time.
class PointTreePair {
 public:
  PointTreePair(const std::vector<Vector<3>>& a, const std::vector<Vector<3>>& b, int threads);
  const PointTree& a() const { return *trees_[0]; }
  const PointTree& b() const { return *trees_[1]; }

 private:
  std::unique_ptr<PointTree> trees_[2];
};

/// For every point of `from` the distance to the nearest point of `to` [m], in the order the points of `from` came
/// in. Neither tree is empty. `threads` = 0: all; never shows in the result. `comparisons`, if given: how many pairs of
/// points were looked at, what the time goes into.
std::vector<double> nearestDistances(const PointTree& from, const PointTree& to, int threads,
                                     std::size_t* comparisons = nullptr);

/// The largest of these distances [m], the same to the last bit, without computing them all. Here the threads show in
/// the comparisons.
double largestNearestDistance(const PointTree& from, const PointTree& to, int threads,
                              std::size_t* comparisons = nullptr);

}  // namespace gaussmap::detail
