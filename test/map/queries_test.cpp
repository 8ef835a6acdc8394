// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/queries.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gaussmap/mapping/build.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

using test::randomCloud;

template <int D>
void expectNearestToBeTheBruteForceOne(const MapOptions& options, double extent) {
  const GaussianMap<D> map = build<D>(randomCloud<D>(2000, 21), options);
  Random random(22);
  for (int s = 0; s < map.scales(); ++s)
    for (int query = 0; query < 300; ++query) {
      Vector<D> point;
      for (int axis = 0; axis < D; ++axis) point(axis) = extent * (2.0 * random.uniform() - 1.0);
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < map.gaussianCount(s); ++i)
        least = std::min(least, (map.gaussian(i, s).mean - point).norm());
      const auto found = nearest<D>(map, point, s);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->distance, least, 1e-12 * (1.0 + least));
      EXPECT_NEAR((map.gaussian(found->index, s).mean - point).norm(), least, 1e-12 * (1.0 + least));
    }
}
TEST(NearestGaussian, IsTheBruteForceOneNearTheMap) {
  expectNearestToBeTheBruteForceOne<3>({0.1, 5, 3, 0.0}, 3.0);
}
TEST(NearestGaussian, IsTheBruteForceOneFarFromTheMap) {
  expectNearestToBeTheBruteForceOne<3>({0.1, 5, 3, 0.0}, 300.0);
}
TEST(NearestGaussian, IsTheBruteForceOneInThePlane) {
  expectNearestToBeTheBruteForceOne<2>({0.05, 10, 2, 0.0}, 5.0);
}
TEST(NearestGaussian, IsTheBruteForceOneOfASingleScale) {
  expectNearestToBeTheBruteForceOne<3>({0.1, 2, 1, 0.0}, 5.0);
}

TEST(NearestGaussian, OfAnEmptyMapIsNothing) {
  EXPECT_FALSE(nearest<3>(GaussianMapOctree(), {0, 0, 0}, 0));
}

TEST(LogLikelihood, OfASingleGaussianIsItsLogDensity) {
  const GaussianMapOctree map = build<3>({{0.05, 0.05, 0.05}, {0.06, 0.05, 0.05}}, {0.1, 10, 1, 0.0});
  const Vector<3> point(0.12, 0.03, 0.05);  // in the cell next to it
  EXPECT_NEAR(logLikelihood<3>(map, point, 0), logDensity<3>(point, map.gaussian(0, 0)), 1e-9);
}

TEST(LogLikelihood, OfAMixtureIsTheSumOverTheNeighbours) {
  const GaussianMapOctree map = build<3>(randomCloud<3>(2000, 23), {0.5, 2, 1, 0.0});
  Random random(24);
  for (int query = 0; query < 200; ++query) {
    const Vector<3> point(2 * random.uniform(), 2 * random.uniform(), 2 * random.uniform());
    double density = 0.0;
    const CellKey<3> home = map.grid().keyOf(point);
    for (std::size_t i = 0; i < map.gaussianCount(0); ++i) {
      const CellKey<3>& key = map.scale(0).keys[i];
      int apart = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) apart = std::max(apart, std::abs(key[axis] - home[axis]));
      if (apart > 1) continue;
      const Gaussian<3> gaussian = map.gaussian(i, 0);
      density += gaussian.weight / 2000.0 * std::exp(logDensity<3>(point, gaussian));
    }
    const double expected = std::log(density);
    if (expected > -500.0) {
      EXPECT_NEAR(logLikelihood<3>(map, point, 0), expected, 1e-6 * std::abs(expected) + 1e-6);
    }
  }
}

TEST(LogLikelihood, FarFromEveryCellIsMinusInfinity) {
  const GaussianMapOctree map = build<3>({{0, 0, 0}}, {});
  EXPECT_EQ(logLikelihood<3>(map, {50, 50, 50}, 0), -std::numeric_limits<double>::infinity());
}

TEST(NormalAt, OfAFloorIsVertical) {
  Random random(25);
  std::vector<Vector<3>> floor;
  for (int i = 0; i < 20000; ++i)
    floor.emplace_back(4 * random.uniform(), 4 * random.uniform(), 0.02 + 0.001 * random.normal());
  const GaussianMapOctree map = build<3>(floor, {0.2, 5, 2, 0.0});
  const auto normal = normalAt<3>(map, {2.03, 1.97, 0.02});
  ASSERT_TRUE(normal);
  EXPECT_GT(std::abs(normal->z()), 0.999);
  EXPECT_FALSE(normalAt<3>(map, {2, 2, 30}));
}

TEST(NormalAt, ComesFromACoarserScaleWhereTheFinestCellHasTooFewPoints) {
  std::vector<Vector<3>> sparse;
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y) sparse.emplace_back(0.1 * x + 0.05, 0.1 * y + 0.05, 0.05);
  const auto normal = normalAt<3>(build<3>(sparse, {0.1, 10, 2, 0.0}), {0.55, 0.55, 0.05});
  ASSERT_TRUE(normal);
  EXPECT_NEAR(std::abs(normal->z()), 1.0, 1e-9);
  EXPECT_FALSE(normalAt<3>(build<3>(sparse, {0.1, 10, 1, 0.0}), {0.55, 0.55, 0.05}));
}

}  // namespace
}  // namespace gaussmap
