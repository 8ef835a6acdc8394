// SPDX-License-Identifier: BSD-3-Clause
#include "map/coarsen.h"

#include <gtest/gtest.h>

#include "gaussmap/mapping/build.h"
#include "mapping/room.h"

namespace gaussmap {
using namespace detail;

namespace {

MapOptions withRatio(int ratio, int scales = 2) {
  MapOptions options;
  options.ratio = ratio;
  options.scales = scales;
  return options;
}

/// A finest scale of given Gaussians, one a cell; the keys are in key order.
template <int D>
MapScale<D> scaleOf(std::vector<CellKey<D>> keys, std::vector<Gaussian<D>> gaussians) {
  MapScale<D> scale;
  scale.keys = std::move(keys);
  scale.gaussians = std::move(gaussians);
  return scale;
}

TEST(Coarsen, OfNothingIsAnEmptyScale) {
  MapScale<3> finer;
  const MapScale<3> coarse = coarsen(finer, Grid<3>(withRatio(10)), 0);
  EXPECT_TRUE(coarse.keys.empty());
  EXPECT_TRUE(coarse.gaussians.empty());
  EXPECT_EQ(coarse.first_child, std::vector<std::uint32_t>{0});
  EXPECT_TRUE(finer.parent.empty());
}

TEST(Coarsen, CutsTheCellsAtTheBordersOfTheirParents) {  // also left of zero, where division must round down
  const Gaussian<2> unit{{0, 0}, Eigen::Matrix2d::Identity(), 1.0};
  MapScale<2> finer =
      scaleOf<2>({{-11, 0}, {-10, 0}, {-1, 9}, {0, 0}, {9, 9}, {10, 0}}, std::vector<Gaussian<2>>(6, unit));
  const MapScale<2> coarse = coarsen(finer, Grid<2>(withRatio(10)), 0);
  EXPECT_EQ(coarse.keys, (std::vector<CellKey<2>>{{-2, 0}, {-1, 0}, {0, 0}, {1, 0}}));
  EXPECT_EQ(coarse.first_child, (std::vector<std::uint32_t>{0, 1, 3, 5, 6}));
  EXPECT_EQ(finer.parent, (std::vector<std::uint32_t>{0, 1, 1, 2, 2, 3}));
  EXPECT_TRUE(coarse.first_gaussian.empty());
  EXPECT_TRUE(coarse.moments.empty());
}

TEST(Coarsen, MatchesTheMomentsOfTwoChildrenByHand) {
  // Sides 0.1 and 0.2; children 0 and 1 have centres -0.05 and +0.05 about their parent's. Weights 1 and 3.
  const Eigen::Matrix2d cov = 1e-4 * Eigen::Matrix2d::Identity();
  MapScale<2> finer = scaleOf<2>({{0, 0}, {1, 0}}, {{{0.01, 0}, cov, 1.0}, {{-0.02, 0}, cov, 3.0}});
  const Gaussian<2> merged = coarsen(finer, Grid<2>(withRatio(2)), 0).gaussians.at(0);
  EXPECT_EQ(merged.weight, 4.0);
  EXPECT_NEAR(merged.mean.x(), (-0.04 + 3 * 0.03) / 4, 1e-16);
  EXPECT_NEAR(merged.mean.y(), -0.05, 1e-16);
  EXPECT_NEAR(merged.cov(0, 0), 1e-4 + 0.25 * 0.75 * 0.07 * 0.07, 1e-16);
  EXPECT_NEAR(merged.cov(1, 1), 1e-4, 1e-16);
}

TEST(Coarsen, LeavesAnOnlyChildAsItIs) {
  const Gaussian<2> child{{0.01, -0.02}, (Eigen::Matrix2d() << 2e-4, 1e-5, 1e-5, 3e-4).finished(), 7.0};
  MapScale<2> finer = scaleOf<2>({{5, 5}}, {child});
  const Gaussian<2> merged = coarsen(finer, Grid<2>(withRatio(11)), 0).gaussians.at(0);  // the cell in the middle
  EXPECT_EQ(merged.mean, child.mean);
  EXPECT_EQ(merged.cov, child.cov);
  EXPECT_EQ(merged.weight, child.weight);
}

TEST(Coarsen, GivesTheMomentsOfThePointsPlusTheFloorAtEveryScale) {
  Random random(1);
  const std::vector<Vector<3>> points = roomPoints(random, 20000);
  const GaussianMap<3> map = build(points, withRatio(4, 3));
  for (int scale = 1; scale < 3; ++scale) {
    for (std::size_t cell = 0; cell < map.cellCount(scale); ++cell) {
      std::vector<Gaussian<3>> under;
      for (const Vector<3>& point : points)
        if (map.grid().keyOf(point, scale) == map.scale(scale).keys[cell])
          under.push_back({point, Eigen::Matrix3d::Zero(), 1.0});
      const Gaussian<3> expected = merge(under), found = map.gaussian(cell, scale);
      ASSERT_EQ(found.weight, expected.weight);
      const double floor = map.options().noise * map.options().noise;
      EXPECT_LT((found.mean - expected.mean).norm(), 2e-6);  // points snap to steps of 1.5 micrometres
      EXPECT_LT((found.cov - floor * Eigen::Matrix3d::Identity() - expected.cov).norm(), 4e-6 * map.grid().side(scale));
    }
  }
}

TEST(Coarsen, KeepsTheTotalWeight) {
  Random random(2);
  const GaussianMap<3> map = build(roomPoints(random, 12345), withRatio(3, 5));
  for (int scale = 0; scale < 5; ++scale) EXPECT_EQ(map.weight(scale), 12345.0);
}

TEST(Coarsen, GivesTheSameBytesFarFromTheOrigin) {
  Random random(3);
  MapScale<3> near = build(roomPoints(random, 5000), withRatio(4)).scale(0);
  MapScale<3> far = near;
  for (CellKey<3>& key : far.keys)
    for (std::int32_t& coordinate : key) coordinate += 4 * 25000000;  // whole parents, 10,000 km
  const Grid<3> grid(withRatio(4));
  const MapScale<3> a = coarsen(near, grid, 0), b = coarsen(far, grid, 0);
  ASSERT_EQ(a.gaussians.size(), b.gaussians.size());
  for (std::size_t i = 0; i < a.gaussians.size(); ++i) {
    EXPECT_EQ(a.gaussians[i].mean, b.gaussians[i].mean);
    EXPECT_EQ(a.gaussians[i].cov, b.gaussians[i].cov);
  }
  EXPECT_EQ(near.parent, far.parent);
}

TEST(Coarsen, TakesAllGaussiansOfACell) {
  const Eigen::Matrix2d cov = 1e-4 * Eigen::Matrix2d::Identity();
  MapScale<2> finer =
      scaleOf<2>({{0, 0}, {3, 0}}, {{{-0.03, 0}, cov, 2.0}, {{0.03, 0}, cov, 2.0}, {{0, 0.01}, cov, 5.0}});
  finer.first_gaussian = {0, 2, 3};
  const MapScale<2> coarse = coarsen(finer, Grid<2>(withRatio(2)), 0);
  ASSERT_EQ(coarse.gaussians.size(), 2u);
  EXPECT_EQ(finer.parent, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(coarse.gaussians[0].weight, 4.0);
  EXPECT_NEAR(coarse.gaussians[0].cov(0, 0), 1e-4 + 9e-4, 1e-16);
  EXPECT_EQ(gaussiansOf(finer, 0).size(), 2u);
  EXPECT_EQ(gaussiansOf(finer, 1).first, 2u);
}

TEST(LocalGaussian, ComesFromTheMomentsOrAsStored) {
  const GaussianMap<2> map = build(std::vector<Vector<2>>{{0.02, 0.03}, {0.08, 0.07}}, withRatio(10));
  const Gaussian<2> finest = localGaussian(map.scale(0), map.grid(), 0, 0);
  EXPECT_NEAR(finest.mean.norm(), 0.0, 2e-6);
  EXPECT_NEAR(finest.cov(0, 0), 9e-4 + 0.005 * 0.005, 1e-7);
  EXPECT_EQ(finest.weight, 2.0);
  const Gaussian<2> coarse = localGaussian(map.scale(1), map.grid(), 1, 0);
  EXPECT_NEAR((coarse.mean - Eigen::Vector2d(-0.45, -0.45)).norm(), 0.0, 2e-6);
  EXPECT_EQ(coarse.cov, finest.cov);
}

}  // namespace
}  // namespace gaussmap
