// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::test {

using Points = std::vector<Vector<3>>;

/// Returns uniform points in a cube of 1 m with its lowest corner at `corner`.
inline Points cube(std::size_t count, std::uint64_t seed, const Vector<3>& corner = Vector<3>::Zero()) {
  Random random(seed);
  Points points(count);
  for (Vector<3>& point : points)
    for (int axis = 0; axis < 3; ++axis) point(axis) = corner(axis) + random.uniform();
  return points;
}

/// Returns the distance from each point of `from` to the nearest point of `to`, by comparing all pairs.
inline std::vector<double> allPairs(const Points& from, const Points& to) {
  std::vector<double> distances;
  for (const Vector<3>& point : from) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector<3>& other : to) nearest = std::min(nearest, (point - other).squaredNorm());
    distances.push_back(std::sqrt(nearest));
  }
  return distances;
}

struct CloudPair {
  std::string name;
  Points a, b;
};

/// Returns pairs of clouds that are difficult for search trees.
inline std::vector<CloudPair> hostilePairs() {
  std::vector<CloudPair> pairs;
  const Vector<3> one(1, 2, 3), far(1e7, -1e7, 1e7);
  pairs.push_back({"one point and one point", {one}, {Vector<3>(1, 2, 5)}});
  pairs.push_back({"the same cube", cube(1500, 1), cube(1500, 1)});
  pairs.push_back({"two cubes in one place", cube(1500, 2), cube(2000, 3)});
  pairs.push_back({"two cubes 100 m apart", cube(1500, 2), cube(2000, 3, {100, 0, 0})});
  pairs.push_back({"all points equal", Points(2000, one), Points(1000, one)});
  pairs.push_back({"two heaps of equal points", Points(2000, one), Points(1000, -one)});
  pairs.push_back({"a heap and a cube", Points(2000, one), cube(1000, 4)});
  pairs.push_back({"two cubes far away", cube(1500, 5, far), cube(1500, 6, far)});

  Points line = cube(2000, 7), grid, heap = cube(2000, 8), shell = cube(1000, 9), steps, twice = cube(700, 10);
  for (Vector<3>& point : line) point = point.x() * Vector<3>(1, 2, -1);
  for (int i = 0; i < 12 * 12 * 12; ++i) grid.emplace_back(i % 12, i / 12 % 12, i / 144);
  for (Vector<3>& point : heap) point = one + 1e-9 * point;
  heap.push_back(-1000.0 * one);
  for (Vector<3>& point : shell) point = 50.0 * (point - Vector<3>(0.5, 0.5, 0.5)).normalized();
  for (int power = -1000; power < 10; ++power) steps.emplace_back(std::ldexp(1.0, power), 0, 0);
  for (std::size_t i = 0; i < 700; ++i) twice.push_back(twice[i]);
  pairs.push_back({"a line and a cube", line, cube(1500, 11)});
  pairs.push_back({"a line and itself", line, line});
  pairs.push_back({"a grid full of ties and its half shift", grid, [&] {
                     Points shifted = grid;
                     for (Vector<3>& point : shifted) point += Vector<3>(0.5, 0.5, 0.5);
                     return shifted;
                   }()});
  pairs.push_back({"a tiny heap with an outlier and a line", heap, line});
  pairs.push_back({"a tiny heap with an outlier and itself backwards", heap, Points(heap.rbegin(), heap.rend())});
  pairs.push_back({"a shell around a cube", shell, cube(1500, 12)});  // all points are at similar distances
  pairs.push_back({"gaps that double 1000 times and a cube", steps, cube(500, 13)});
  pairs.push_back({"every point twice and a cube", twice, cube(500, 14)});
  pairs.push_back({"a few points far apart and a cube", {1e6 * one, -1e6 * one, one, far}, cube(1500, 15)});
  return pairs;
}

}  // namespace gaussmap::test
