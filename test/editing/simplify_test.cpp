// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/simplify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "editing/thinned_map.h"
#include "gaussmap/editing/transform_map.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/queries.h"
#include "io/gmap/map_equality.h"
#include "map/inherit_occupancy.h"
#include "mapping/map_checks.h"
#include "mapping/refine_helpers.h"

namespace gaussmap::test {
using namespace detail;

namespace {

TEST(Simplify, LeavesAsManyGaussiansAsAskedFor) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(9000, 1), smallGrid<3>());
  for (const double budget : {2.5, 1.7, 1.0}) {
    const GaussianMap<3> simple = simplify<3>(map, PerCell{budget}).map;
    EXPECT_TRUE(sameFinest<3>(simple, map));
    EXPECT_TRUE(simple.acceptsScans());
    for (int s = 1; s < 3; ++s) {
      EXPECT_EQ(simple.gaussianCount(s), static_cast<std::size_t>(std::floor(budget * double(map.cellCount(s)))));
      EXPECT_EQ(simple.weight(s), map.weight(s));
    }
    expectMomentMatches<3>(simple);
  }
}

TEST(Simplify, ToOneGaussianACellIsTheUnrefinedMap) {
  const std::vector<Vector<3>> points = randomCloud<3>(9000, 2);
  const GaussianMap<3> simple = simplify<3>(refinedMap<3>(points, smallGrid<3>()), PerCell{1.0}).map;
  const GaussianMap<3> unrefined = build<3>(points, smallGrid<3>());
  for (int s = 0; s < 3; ++s) {
    ASSERT_EQ(simple.gaussianCount(s), unrefined.gaussianCount(s));
    for (std::size_t i = 0; i < simple.gaussianCount(s); ++i)
      expectSameMatch<3>(simple.gaussian(i, s), unrefined.gaussian(i, s));
  }
}

TEST(Simplify, LeavesAMapThatIsSmallEnoughAsItIs) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(3000, 2), smallGrid<3>());
  expectSameMap<3>(simplify<3>(map, PerCell{100.0}).map, map);
  expectSameMap<3>(simplify<3>(map, MaxGaussians{}).map, map);
  EXPECT_TRUE(simplify<3>(GaussianMap<3>(smallGrid<3>()), PerCell{1.0}).map.empty());
}

TEST(Simplify, MergesTheScaleThatWasNamedOnly) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(9000, 3), smallGrid<3>());
  const GaussianMap<3> simple = simplify<3>(map, MaxGaussians{{{1, map.cellCount(1) + 7}}}).map;
  EXPECT_EQ(simple.gaussianCount(1), map.cellCount(1) + 7);
  EXPECT_LE(simple.gaussianCount(2), map.gaussianCount(2));  // a cluster goes if all of its own went to others
  expectMomentMatches<3>(simple);
  const GaussianMap<3> coarse = simplify<3>(map, MaxGaussians{{{2, map.cellCount(2)}}}).map;
  EXPECT_EQ(coarse.gaussianCount(1), map.gaussianCount(1));
  EXPECT_EQ(coarse.gaussianCount(2), map.cellCount(2));
  expectMomentMatches<3>(coarse);
}

TEST(Simplify, MergesTheTwoThatAreClosest) {
  // Cells of 0.1 m under one of 0.8 m; three clusters in a row, the first two near each other.
  const std::vector<Vector<2>> points = {{0.05, 0.05}, {0.15, 0.05}, {0.75, 0.05}};
  const MapOptions grid = smallGrid<2>(8, 2);
  const GaussianMap<2> map = refinedMap<2>(points, grid);
  ASSERT_EQ(map.gaussianCount(1), 3u);
  const GaussianMap<2> simple = simplify<2>(map, MaxGaussians{{{1, 2}}}).map;
  ASSERT_EQ(simple.gaussianCount(1), 2u);
  EXPECT_EQ(simple.parentOf(0, 0), simple.parentOf(1, 0));
  EXPECT_NE(simple.parentOf(0, 0), simple.parentOf(2, 0));
}

TEST(Simplify, NeedsNoFinerScale) {
  const GaussianMap<3> map = thinned<3>(refinedMap<3>(randomCloud<3>(9000, 4), smallGrid<3>()));
  ASSERT_TRUE(map.isCompressed());
  const GaussianMap<3> simple = simplify<3>(map, PerCell{1.0}).map;
  EXPECT_TRUE(simple.isCompressed());
  double weight = 0.0, old_weight = 0.0;
  for (const GaussianId& leaf : leaves(simple)) weight += simple.gaussian(leaf.index, leaf.scale).weight;
  for (const GaussianId& leaf : leaves(map)) old_weight += map.gaussian(leaf.index, leaf.scale).weight;
  EXPECT_NEAR(weight, old_weight, 1e-6);
  for (int s = 0; s < 3; ++s) EXPECT_EQ(simple.gaussianCount(s), map.cellCount(s));
  expectMomentMatches<3>(simple);
  for (int s = 1; s < 3; ++s) expectSameMatch<3>(matchOfScale<3>(simple, s), matchOfScale<3>(map, s));
}

TEST(Simplify, MergesGaussiansThatShareAFinestCell) {
  Pose motion;
  motion.translation = {0.04, 0.03, 0.05};
  GaussianMap<3> map = transformMap<3>(build<3>(randomCloud<3>(9000, 5), smallGrid<3>()), motion);
  map = withOccupancy<3>(map, std::vector<float>(map.gaussianCount(0), 1.5f));
  ASSERT_GT(map.gaussianCount(0), map.cellCount(0));
  const GaussianMap<3> simple = simplify<3>(map, PerCell{1.0}).map;
  EXPECT_EQ(simple.gaussianCount(0), map.cellCount(0));
  EXPECT_EQ(simple.logOdds(0, 0), 1.5f);
  expectMomentMatches<3>(simple);
  expectSameMatch<3>(matchOfScale<3>(simple, 0), matchOfScale<3>(map, 0));
}

GaussianMap<3> detailedRoom() {
  return refine<3>(roomMap(20000, 5, 2), PerCell{8.0}).map;
}

TEST(Simplify, KeepsTheErrorThatItIsGiven) {
  const GaussianMap<3> map = detailedRoom();
  ErrorSampling sampling;
  sampling.samples = 5000;
  sampling.data = 20000;
  std::size_t last = map.gaussianCount(1);
  for (const double error : {0.1, 0.13, 0.2}) {
    const RefineResult<3> simple = simplify(map, MaxError{error, sampling});
    EXPECT_TRUE(simple.not_reached.empty());
    EXPECT_LT(simple.map.gaussianCount(1), last) << error;
    last = simple.map.gaussianCount(1);
    expectMomentMatches<3>(simple.map);
  }
  const RefineResult<3> strict = simplify(map, MaxError{1e-6, sampling});
  expectSameMap<3>(strict.map, map);
  ASSERT_EQ(strict.not_reached.size(), 1u);
  EXPECT_EQ(strict.not_reached[0].scale, 1);
  EXPECT_GT(strict.not_reached[0].q95, 1e-6);
}

TEST(Simplify, KeepsTheBytesThatItIsGiven) {
  const GaussianMap<3> map = detailedRoom();
  const auto bytesOf = [](const GaussianMap<3>& one) { return savedSize<3>(one); };
  const auto within = [&](std::uintmax_t bytes) { return simplify(map, maxFileBytes(bytes)).map; };
  const std::uintmax_t all = bytesOf(map), least = bytesOf(simplify<3>(map, PerCell{1.0}).map);
  const std::uintmax_t most = (all + least) / 2;
  const GaussianMap<3> simple = within(most);
  EXPECT_LE(bytesOf(simple), most);
  EXPECT_GT(bytesOf(simple), least);
  expectSameMap<3>(within(all), map);
  EXPECT_THROW(within(least - 1), std::invalid_argument);
}

TEST(Simplify, RefusesLimitsThatMakeNoSense) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(3000, 2), smallGrid<3>());
  EXPECT_THROW(simplify<3>(map, PerCell{0.9}), std::invalid_argument);
  EXPECT_THROW(simplify<3>(map, PerCell{std::nan("")}), std::invalid_argument);
  EXPECT_THROW(simplify<3>(map, MaxGaussians{{{1, map.cellCount(1) - 1}}}), std::invalid_argument);
  EXPECT_THROW(simplify<3>(map, MaxGaussians{{{3, 1000}}}), std::invalid_argument);
  EXPECT_THROW(simplify<3>(map, MaxError{}), std::invalid_argument);
  EXPECT_THROW(simplify<3>(map, MaxBytes{1000, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap::test
