// SPDX-License-Identifier: BSD-3-Clause
#include "map/in_space.h"

#include <gtest/gtest.h>

#include "editing/thinned_map.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/inherit_occupancy.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

using namespace detail;
using test::randomCloud;

GaussianMap<2> planarMap(double resolution = 0.05, int ratio = 4, double shift = 0.0) {
  std::vector<Vector<2>> points = randomCloud<2>(3000, 5);
  for (Vector<2>& point : points) point.x() += shift;
  return refine<2>(build<2>(points, {resolution, ratio, 3, 0.0}), PerCell{2.5}).map;
}

/// Checks every property that inSpace() promises.
void expectSameInSpace(const GaussianMap<2>& map) {
  const GaussianMap<3> space = inSpace(map);
  ASSERT_EQ(space.options(), map.options());
  EXPECT_EQ(space.hasOccupancy(), map.hasOccupancy());
  EXPECT_EQ(space.isCompressed(), map.isCompressed());
  for (int s = 0; s < map.scales(); ++s) {
    ASSERT_EQ(space.cellCount(s), map.cellCount(s));
    ASSERT_EQ(space.gaussianCount(s), map.gaussianCount(s));
    EXPECT_EQ(space.weight(s), map.weight(s));
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
      const CellKey<2>& key = map.scale(s).keys[cell];
      ASSERT_EQ(space.scale(s).keys[cell], (CellKey<3>{key[0], key[1], 0}));
      ASSERT_EQ(space.find({key[0], key[1], 0}, s), cell);
      EXPECT_EQ(space.isLeaf(cell, s), map.isLeaf(cell, s));
    }
    for (std::size_t i = 0; i < map.gaussianCount(s); ++i) {
      const Gaussian<2> flat = map.gaussian(i, s);
      const Gaussian<3> lifted = space.gaussian(i, s);
      EXPECT_EQ(lifted.mean, Vector<3>(flat.mean.x(), flat.mean.y(), 0.0));
      EXPECT_EQ((lifted.cov.topLeftCorner<2, 2>()), flat.cov);
      EXPECT_EQ(lifted.cov(2, 2), map.options().noise * map.options().noise);
      EXPECT_EQ((lifted.cov.topRightCorner<2, 1>().norm()), 0.0);
      EXPECT_EQ(lifted.weight, flat.weight);
      EXPECT_EQ(space.logOdds(i, s), map.logOdds(i, s));
      EXPECT_EQ(space.cellOf(i, s), map.cellOf(i, s));
      EXPECT_EQ(space.grid().keyOf(lifted.mean, s)[2], 0);
      EXPECT_NO_THROW(logDeterminant<3>(lifted.cov));  // positive definite
      if (s + 1 < map.scales()) {
        EXPECT_EQ(space.parentOf(i, s), map.parentOf(i, s));
      }
      if (s > 0) {
        EXPECT_EQ(space.childrenOf(i, s), map.childrenOf(i, s));
      }
    }
  }
}

TEST(InSpace, KeepsCellsGaussiansAndLinks) {
  expectSameInSpace(planarMap());
  expectSameInSpace(planarMap(0.1, 10));
  expectSameInSpace(planarMap(0.07, 3));             // a side that is not exact in binary
  expectSameInSpace(planarMap(0.05, 4, 4500000.0));  // coordinates as in UTM
  expectSameInSpace(GaussianMap<2>({0.05, 4, 2, 0.0}));
}

TEST(InSpace, KeepsCompressedFinalAndOccupiedMaps) {
  const GaussianMap<2> map = planarMap();
  expectSameInSpace(test::thinned(map));
  expectSameInSpace(finish<2>(map));
  std::vector<float> log_odds;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) log_odds.push_back(static_cast<float>(i % 11) - 3.0f);
  expectSameInSpace(withOccupancy<2>(map, log_odds));
}

TEST(InSpace, IsTheMapOfThePointsAtHeightZero) {
  const std::vector<Vector<2>> points = randomCloud<2>(3000, 6);
  const MapOptions options{0.05, 4, 3, 0.0};
  const GaussianMap<3> space = inSpace(build<2>(points, options)), built = build<3>(inSpace(points), options);
  for (int s = 0; s < built.scales(); ++s) {
    ASSERT_EQ(space.scale(s).keys, built.scale(s).keys);
    for (std::size_t i = 0; i < built.gaussianCount(s); ++i) {
      EXPECT_LT((space.gaussian(i, s).mean - built.gaussian(i, s).mean).norm(), 1e-12);
      EXPECT_LT((space.gaussian(i, s).cov - built.gaussian(i, s).cov).norm(), 1e-12);
      EXPECT_EQ(space.gaussian(i, s).weight, built.gaussian(i, s).weight);
    }
  }
}

}  // namespace
}  // namespace gaussmap
