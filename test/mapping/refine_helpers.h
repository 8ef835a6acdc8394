// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/coarsen.h"
#include "mapping/cell_error.h"
#include "mapping/room.h"

namespace gaussmap {
using namespace detail;

inline constexpr RefineMethod kMethods[] = {RefineMethod::Agglomerate, RefineMethod::Insert};

inline GaussianMap<3> roomMap(std::size_t points = 60000, int ratio = 5, int scales = 3) {
  Random random(1);
  MapOptions options;
  options.ratio = ratio;
  options.scales = scales;
  return build(roomPoints(random, points), options);
}

inline RefineOptions by(RefineMethod method) {
  RefineOptions options;
  options.method = method;
  return options;
}

/// Returns the Gaussians of scale s - 1 below a cell of scale s, with means relative to the centre of the cell.
inline std::vector<Gaussian<3>> dataUnder(const GaussianMap<3>& map, std::size_t cell, int s) {
  std::vector<Gaussian<3>> data;
  gatherUnder(map.scale(s - 1), map.grid(), s - 1, map.childCells(cell, s), data);
  return data;
}

inline std::vector<Gaussian<3>> clustersOf(const GaussianMap<3>& map, std::size_t cell, int s) {
  std::vector<Gaussian<3>> clusters;
  const IndexRange range = map.gaussiansOf(cell, s);
  for (std::size_t i = range.first; i < range.last; ++i) clusters.push_back(map.localGaussian(i, s));
  return clusters;
}

inline double errorOf(const GaussianMap<3>& map, std::size_t cell, int s) {
  return cellError(clustersOf(map, cell, s), dataUnder(map, cell, s));
}

inline double meanError(const GaussianMap<3>& map, int s) {
  double sum = 0.0;
  for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) sum += errorOf(map, cell, s);
  return sum / static_cast<double>(map.cellCount(s));
}

template <int D>
void expectSameBytes(const GaussianMap<D>& a, const GaussianMap<D>& b) {
  ASSERT_EQ(a.scales(), b.scales());
  for (int s = 0; s < a.scales(); ++s) {
    const MapScale<D>&p = a.scale(s), &q = b.scale(s);
    EXPECT_EQ(p.keys, q.keys);
    EXPECT_EQ(p.first_child, q.first_child);
    EXPECT_EQ(p.first_gaussian, q.first_gaussian);
    EXPECT_EQ(p.parent, q.parent);
    EXPECT_TRUE(p.moments == q.moments);
    ASSERT_EQ(p.gaussians.size(), q.gaussians.size());
    for (std::size_t i = 0; i < p.gaussians.size(); ++i) {
      ASSERT_EQ(p.gaussians[i].mean, q.gaussians[i].mean);
      ASSERT_EQ(p.gaussians[i].cov, q.gaussians[i].cov);
      ASSERT_EQ(p.gaussians[i].weight, q.gaussians[i].weight);
    }
  }
}

}  // namespace gaussmap
