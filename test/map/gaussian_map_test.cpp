// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/gaussian_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "gaussmap/mapping/build.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

using test::randomCloud;

template <int D>
void expectCoarseScalesToBeMomentsOfThePoints(const MapOptions& options) {
  const std::vector<Vector<D>> points = randomCloud<D>(5000, 11);
  const GaussianMap<D> map = build<D>(points, options);
  for (int s = 0; s < map.scales(); ++s) {
    std::map<CellKey<D>, std::vector<Gaussian<D>>> cells;
    const double floor = map.options().noise * map.options().noise;
    for (const Vector<D>& point : points)
      cells[map.grid().keyOf(point, s)].push_back({point, floor * Matrix<D>::Identity(), 1.0});
    ASSERT_EQ(map.cellCount(s), cells.size());
    EXPECT_DOUBLE_EQ(map.weight(s), 5000.0);
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
      const Gaussian<D> expected = merge<D>(cells.at(map.scale(s).keys[cell]));
      const Gaussian<D> got = map.gaussian(map.gaussiansOf(cell, s).first, s);
      EXPECT_DOUBLE_EQ(got.weight, expected.weight);
      EXPECT_LT((got.mean - expected.mean).template lpNorm<Eigen::Infinity>(), 1e-5 * options.resolution);
      EXPECT_LT((got.cov - expected.cov).norm(), 1e-4 * options.resolution * map.grid().side(s));
    }
  }
}
TEST(GaussianMap, HoldsTheMomentsOfThePointsAtEveryScale) {
  expectCoarseScalesToBeMomentsOfThePoints<3>({0.1, 10, 3, 0.0});
  expectCoarseScalesToBeMomentsOfThePoints<3>({0.1, 2, 5, 0.0});
  expectCoarseScalesToBeMomentsOfThePoints<3>({0.3, 3, 1, 0.0});
}
TEST(GaussianMap, HoldsTheMomentsOfThePointsInThePlane) {
  expectCoarseScalesToBeMomentsOfThePoints<2>({0.05, 10, 3, 0.0});
}

TEST(GaussianMap, FindsEveryCellAndNoOther) {
  const GaussianMapOctree map = build<3>(randomCloud<3>(3000, 12), {0.1, 5, 3, 0.0});
  Random random(1);
  for (int s = 0; s < map.scales(); ++s) {
    std::map<CellKey<3>, std::size_t> cells;
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
      cells[map.scale(s).keys[cell]] = cell;
      EXPECT_EQ(map.find(map.scale(s).keys[cell], s), cell);
    }
    EXPECT_EQ(cells.size(), map.cellCount(s));
    for (int i = 0; i < 3000; ++i) {
      CellKey<3> key;
      for (std::int32_t& coordinate : key) coordinate = static_cast<std::int32_t>(random.below(40)) - 20;
      const auto expected = cells.find(key);
      const auto got = map.find(key, s);
      EXPECT_EQ(got.has_value(), expected != cells.end());
      if (got && expected != cells.end()) {
        EXPECT_EQ(*got, expected->second);
      }
    }
  }
}

TEST(GaussianMap, ListsChildrenNextToEachOther) {
  const GaussianMapOctree map = build<3>(randomCloud<3>(3000, 13), {0.1, 4, 3, 0.0});
  for (int s = 1; s < map.scales(); ++s) {
    std::size_t next = 0;
    for (std::size_t cell = 0; cell < map.cellCount(s); ++cell) {
      const IndexRange children = map.childCells(cell, s);
      EXPECT_EQ(children.first, next);
      EXPECT_FALSE(children.empty());
      next = children.last;
      for (std::size_t child = children.first; child < children.last; ++child)
        EXPECT_EQ(map.grid().ancestor(map.scale(s - 1).keys[child], s - 1, s), map.scale(s).keys[cell]);
      EXPECT_EQ(map.childrenOf(map.gaussiansOf(cell, s).first, s).size(), map.gaussiansUnder(cell, s).size());
    }
    EXPECT_EQ(next, map.cellCount(s - 1));
  }
}

TEST(GaussianMap, IteratesInKeyOrder) {
  const GaussianMapOctree map = build<3>(randomCloud<3>(3000, 14), {0.1, 3, 3, 0.0});
  for (int s = 0; s < map.scales(); ++s)
    for (std::size_t cell = 1; cell < map.cellCount(s); ++cell) {
      const auto path = [&](std::size_t i) {  // the definition: ancestors from the coarsest scale down
        std::vector<CellKey<3>> keys;
        for (int level = map.scales() - 1; level >= s; --level)
          keys.push_back(map.grid().ancestor(map.scale(s).keys[i], s, level));
        return keys;
      };
      EXPECT_LT(path(cell - 1), path(cell));
    }
}

/// By the definition: ancestors from the coarsest scale down.
void expectKeyOrder(const std::vector<CellKey<3>>& keys) {
  const std::vector<std::uint32_t> order = keyOrder<3>(keys, 10, 2);
  const Grid<3> grid({1.0, 10, 3, 0.0});
  std::set<std::uint32_t> seen(order.begin(), order.end());
  EXPECT_EQ(seen.size(), keys.size());
  const auto path = [&](std::size_t i) {
    const CellKey<3>& key = keys[order[i]];
    return std::array<CellKey<3>, 3>{grid.ancestor(key, 0, 2), grid.ancestor(key, 0, 1), key};
  };
  for (std::size_t i = 1; i < keys.size(); ++i) EXPECT_LE(path(i - 1), path(i));
}

TEST(KeyOrder, SortsKeysTooFarApartForOneMachineWord) {
  Random random(15);
  std::vector<CellKey<3>> keys(2000);
  for (CellKey<3>& key : keys)
    for (std::int32_t& coordinate : key) coordinate = static_cast<std::int32_t>(random.bits());
  expectKeyOrder(keys);
}

TEST(KeyOrder, SortsAlongShortAndLongAxes) {
  Random random(17);
  for (const int long_axes : {0, 1, 2}) {
    std::vector<CellKey<3>> keys(2000);
    for (CellKey<3>& key : keys)
      for (int axis = 0; axis < 3; ++axis)
        key[std::size_t(axis)] =
            static_cast<std::int32_t>(random.below(axis < long_axes ? 1000000 : 150)) - (axis == 1 ? 75 : 0);
    expectKeyOrder(keys);
  }
}

TEST(GaussianMap, FarFromTheOriginIsTheMapAtTheOriginShifted) {
  std::vector<Vector<3>> points = randomCloud<3>(3000, 16), far;
  for (Vector<3>& point : points) {  // on a lattice that survives the shift
    for (int axis = 0; axis < 3; ++axis) point(axis) = std::round(point(axis) * 4096.0) / 4096.0;
    far.push_back(point + Vector<3>(5e6, -5e6, 5e6));
  }
  const MapOptions options{0.125, 10, 3, 0.0};
  const GaussianMapOctree here = build<3>(points, options), there = build<3>(far, options);
  for (int s = 0; s < 3; ++s) {
    ASSERT_EQ(here.gaussianCount(s), there.gaussianCount(s));
    for (std::size_t i = 0; i < here.gaussianCount(s); ++i) {
      EXPECT_EQ(here.localGaussian(i, s).mean, there.localGaussian(i, s).mean);
      EXPECT_EQ(here.localGaussian(i, s).cov, there.localGaussian(i, s).cov);
    }
  }
}

TEST(GaussianMap, OfNothingIsEmpty) {
  const GaussianMapOctree map = build<3>(std::vector<Vector<3>>{}, {});
  EXPECT_TRUE(map.empty());
  EXPECT_TRUE(map.acceptsScans());
  EXPECT_EQ(map.weight(2), 0.0);
  EXPECT_FALSE(map.find({0, 0, 0}, 1));
}

TEST(GaussianMap, OfOnePointHasOneGaussianAtEveryScale) {
  const GaussianMapOctree map = build<3>({{1.25, -3.5, 0.0}}, {});
  for (int s = 0; s < 3; ++s) {
    ASSERT_EQ(map.gaussianCount(s), 1u);
    EXPECT_LT((map.gaussian(0, s).mean - Vector<3>(1.25, -3.5, 0.0)).norm(), 2e-6);
    EXPECT_LT((map.gaussian(0, s).cov - 2.5e-5 * Matrix<3>::Identity()).norm(), 1e-12);
  }
}

/// Two coarse cells, with one finest cell under the first and two under the second.
std::vector<MapScale<3>> twoCoarseCells(const MapOptions& options) {
  const GaussianMapOctree map = build<3>({{0.05, 0, 0}, {1.05, 0, 0}, {1.55, 0, 0}}, options);
  return {map.scale(0), map.scale(1)};
}

TEST(GaussianMap, MayHaveCoarseCellsThatStandAlone) {
  const MapOptions options{0.1, 10, 2, 0.0};
  std::vector<MapScale<3>> scales = twoCoarseCells(options);
  scales[0].keys.resize(1);
  scales[0].moments.resize(1);
  scales[0].parent.resize(1);
  scales[1].first_child = {0, 1, 1};
  const GaussianMapOctree map(options, scales);
  EXPECT_TRUE(map.isCompressed());
  EXPECT_FALSE(map.acceptsScans());
  EXPECT_EQ(map.weight(0), 1.0);
  EXPECT_EQ(map.weight(1), 3.0);
  EXPECT_FALSE(map.isLeaf(0, 1));
  EXPECT_TRUE(map.isLeaf(1, 1));
  EXPECT_TRUE(map.isLeaf(0, 0));
  EXPECT_TRUE(map.childCells(1, 1).empty());
  EXPECT_TRUE(map.gaussiansUnder(1, 1).empty());
  EXPECT_TRUE(map.childrenOf(1, 1).empty());
  EXPECT_EQ(map.find({0, 0, 0}, 0), 0u);
  EXPECT_FALSE(map.find({10, 0, 0}, 0));
  EXPECT_EQ(map.find({1, 0, 0}, 1), 1u);
}

TEST(GaussianMap, MayHaveNothingButItsCoarsestScale) {
  const MapOptions options{0.1, 10, 2, 0.0};
  std::vector<MapScale<3>> scales = twoCoarseCells(options);
  scales[0] = {};
  scales[1].first_child = {0, 0, 0};
  const GaussianMapOctree map(options, scales);
  EXPECT_FALSE(map.empty());
  EXPECT_FALSE(map.acceptsScans());
  EXPECT_TRUE(map.gaussiansUnder(0, 1).empty());
  EXPECT_EQ(map.weight(0), 0.0);
}

TEST(GaussianMap, HasNoFinerCellWithoutACoarseOne) {
  const MapOptions options{0.1, 10, 2, 0.0};
  std::vector<MapScale<3>> scales = twoCoarseCells(options);
  scales[1] = {};
  scales[1].first_child = {0};
  EXPECT_THROW(GaussianMapOctree(options, scales), std::invalid_argument);
}

TEST(GaussianMap, RefusesScalesThatDoNotFitTogether) {
  const MapOptions options{0.1, 10, 2, 0.0};
  const GaussianMapOctree good = build<3>(randomCloud<3>(500, 17), options);
  const auto scales = [&] { return std::vector<MapScale<3>>{good.scale(0), good.scale(1)}; };
  EXPECT_NO_THROW(GaussianMapOctree(options, scales()));
  const auto expectRefused = [&](auto&& spoil) {
    std::vector<MapScale<3>> spoilt = scales();
    spoil(spoilt);
    EXPECT_THROW(GaussianMapOctree(options, std::move(spoilt)), std::invalid_argument);
  };
  expectRefused([](auto& s) { s.pop_back(); });
  expectRefused([](auto& s) { std::swap(s[0].keys[0], s[0].keys[1]); });
  expectRefused([](auto& s) { s[0].keys[1] = s[0].keys[0]; });
  expectRefused([](auto& s) { s[0].moments.pop_back(); });
  expectRefused([](auto& s) { s[0].moments[0].count = 0; });
  expectRefused([](auto& s) { s[0].parent[0] = 100000; });
  expectRefused([](auto& s) { s[0].parent.clear(); });
  expectRefused([](auto& s) { s[1].first_child[1] = s[1].first_child[0]; });
  expectRefused([](auto& s) { std::swap(s[1].first_child[1], s[1].first_child[2]); });
  expectRefused([](auto& s) { s[1].first_child.back() -= 1; });
  expectRefused([](auto& s) { s[1].gaussians[0].weight = 0.0; });
  expectRefused([](auto& s) { s[1].gaussians[0].mean.x() = 0.6; });
  expectRefused([](auto& s) { s[1].gaussians[0].mean.z() = std::nan(""); });
  expectRefused([](auto& s) { s[1].gaussians[0].weight = HUGE_VAL; });
  expectRefused([](auto& s) { s[1].gaussians.push_back(s[1].gaussians[0]); });
}

}  // namespace
}  // namespace gaussmap
