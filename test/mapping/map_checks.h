// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/random_clouds.h"

namespace gaussmap::test {

template <int D>
MapOptions smallGrid(int ratio = 4, int scales = 3) {
  MapOptions options;
  options.resolution = 0.1;
  options.ratio = ratio;
  options.scales = scales;
  return options;
}

/// Returns a map with three Gaussians per coarse cell, or fewer if the cell has fewer finer ones.
template <int D>
GaussianMap<D> refinedMap(const std::vector<Vector<D>>& points, const MapOptions& options) {
  RefineOptions refinement;
  refinement.threads = 1;
  return refine<D>(build<D>(points, options), PerCell{}, refinement).map;
}

/// Checks that every coarse cluster, except leaves, has children and is their moment match.
template <int D>
void expectMomentMatches(const GaussianMap<D>& map) {
  for (int s = 1; s < map.scales(); ++s) {
    for (std::size_t i = 0; i < map.gaussianCount(s); ++i) {
      if (map.isLeaf(map.cellOf(i, s), s)) continue;
      std::vector<Gaussian<D>> members;
      for (const std::size_t child : map.childrenOf(i, s)) members.push_back(map.gaussian(child, s - 1));
      ASSERT_FALSE(members.empty()) << "scale " << s << ", Gaussian " << i;
      const Gaussian<D> match = merge(members), cluster = map.gaussian(i, s);
      const double side = map.grid().side(s);
      ASSERT_NEAR(match.weight, cluster.weight, 1e-9 * match.weight);
      ASSERT_LT((match.mean - cluster.mean).norm(), 1e-9 * side);
      ASSERT_LT((match.cov - cluster.cov).norm(), 1e-9 * side * side);
    }
  }
}

/// Returns the moment match of a whole scale. Sorting and merging must not change it.
template <int D>
Gaussian<D> matchOfScale(const GaussianMap<D>& map, int s) {
  std::vector<Gaussian<D>> all;
  for (std::size_t i = 0; i < map.gaussianCount(s); ++i) all.push_back(map.gaussian(i, s));
  return merge(all);
}

template <int D>
void expectSameMatch(const Gaussian<D>& a, const Gaussian<D>& b, double tolerance = 1e-9) {
  EXPECT_NEAR(a.weight, b.weight, tolerance * a.weight);
  EXPECT_LT((a.mean - b.mean).norm(), tolerance);
  EXPECT_LT((a.cov - b.cov).norm(), tolerance);
}

/// Compares the cells and sums of the finest scales.
template <int D>
testing::AssertionResult sameFinest(const GaussianMap<D>& a, const GaussianMap<D>& b) {
  if (a.scale(0).keys != b.scale(0).keys) return testing::AssertionFailure() << "cells";
  if (a.scale(0).moments != b.scale(0).moments) return testing::AssertionFailure() << "moments";
  return testing::AssertionSuccess();
}

/// Returns the points, moved by a vector.
template <int D>
std::vector<Vector<D>> shifted(std::vector<Vector<D>> points, const Vector<D>& by) {
  for (Vector<D>& point : points) point += by;
  return points;
}

}  // namespace gaussmap::test
