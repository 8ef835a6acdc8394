// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/merge_maps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "editing/thinned_map.h"
#include "gaussmap/editing/transform_map.h"
#include "io/gmap/map_equality.h"
#include "map/inherit_occupancy.h"
#include "mapping/map_checks.h"
#include "simulation/simulation.h"

namespace gaussmap::test {
using namespace detail;

namespace {

/// Points dealt out at random.
template <int D>
std::vector<std::vector<Vector<D>>> split(const std::vector<Vector<D>>& points, std::size_t parts, Random& random) {
  std::vector<std::vector<Vector<D>>> dealt(parts);
  for (const Vector<D>& point : points) dealt[random.below(parts)].push_back(point);
  return dealt;
}

template <int D>
void expectPartsToGiveTheWhole() {
  Random random(3);
  for (const std::size_t parts : {2u, 3u, 7u}) {
    const std::vector<Vector<D>> points = randomCloud<D>(20000, 10 + parts);
    const GaussianMap<D> whole = build<D>(points, smallGrid<D>());
    std::vector<std::vector<Vector<D>>> dealt = split<D>(points, parts, random);
    for (int order = 0; order < 3; ++order) {
      GaussianMap<D> merged(smallGrid<D>());
      for (const std::vector<Vector<D>>& part : dealt) merged = mergeMaps<D>(merged, build<D>(part, smallGrid<D>()));
      expectSameMap<D>(merged, whole);
      std::rotate(dealt.begin(), dealt.begin() + 1, dealt.end());
    }
  }
}

TEST(MergeMaps, GivesTheMapOfAllPointsToTheLastBitInAnyOrder) {
  expectPartsToGiveTheWhole<2>();
  expectPartsToGiveTheWhole<3>();
}

TEST(MergeMaps, GivesTheFinestScaleOfAllPointsForRefinedMapsToo) {
  Random random(4);
  const std::vector<Vector<3>> points = randomCloud<3>(20000, 5);
  const auto dealt = split<3>(points, 3, random);
  const MapOptions grid = smallGrid<3>();
  const GaussianMap<3> a = refinedMap<3>(dealt[0], grid), b = refinedMap<3>(dealt[1], grid),
                       c = refinedMap<3>(dealt[2], grid), whole = build<3>(points, grid);
  EXPECT_TRUE(sameFinest<3>(mergeMaps<3>(mergeMaps<3>(a, b), c), whole));
  EXPECT_TRUE(sameFinest<3>(mergeMaps<3>(a, mergeMaps<3>(b, c)), whole));
  EXPECT_TRUE(sameFinest<3>(mergeMaps<3>(mergeMaps<3>(c, a), b), whole));
  EXPECT_TRUE(mergeMaps<3>(a, b).acceptsScans());
}

TEST(MergeMaps, GivesTheMapOfAllScansForAnyDealOfSimulatedScans) {
  Simulation simulation = makeSimulation(WorldName::Street, {8, false});
  std::get<LidarOptions>(simulation.sensor).columns = 60;
  std::vector<std::vector<Vector<3>>> scans;
  for (std::size_t i = 0; i < 8; ++i) {
    const SimulatedScan scan = simulateScan(simulation, i);
    scans.emplace_back();
    for (const Eigen::Vector3d& point : scan.points) scans.back().push_back(scan.pose * point);
  }
  MapOptions grid;
  const auto mapOf = [&](const std::vector<std::size_t>& chosen) {
    std::vector<Vector<3>> points;
    for (const std::size_t i : chosen) points.insert(points.end(), scans[i].begin(), scans[i].end());
    return build<3>(points, grid);
  };
  const GaussianMap<3> whole = mapOf({0, 1, 2, 3, 4, 5, 6, 7});
  Random random(8);
  for (int deal = 0; deal < 5; ++deal) {
    std::vector<std::vector<std::size_t>> hands(1 + random.below(4));
    for (std::size_t i = 0; i < 8; ++i) hands[random.below(hands.size())].push_back(i);
    GaussianMap<3> merged(grid);
    for (const std::vector<std::size_t>& hand : hands) merged = mergeMaps<3>(merged, mapOf(hand));
    expectSameMap<3>(merged, whole);
  }
}

TEST(MergeMaps, HasTheEmptyMapAsNeutralElement) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(5000, 1), smallGrid<3>()), empty(smallGrid<3>());
  expectSameMap<3>(mergeMaps<3>(map, empty), map);
  expectSameMap<3>(mergeMaps<3>(empty, map), map);
  EXPECT_TRUE(mergeMaps<3>(empty, empty).empty());
}

TEST(MergeMaps, KeepsTheClustersOfCellsThatOneMapHasAlone) {
  const MapOptions grid = smallGrid<3>();
  const std::vector<Vector<3>> points = randomCloud<3>(8000, 2);
  const GaussianMap<3> a = refinedMap<3>(points, grid);
  const GaussianMap<3> b = refinedMap<3>(shifted<3>(points, {16.0, -32.0, 160.0}), grid);  // whole coarsest cells
  const GaussianMap<3> merged = mergeMaps<3>(a, b);
  for (int s = 0; s < 3; ++s) {
    ASSERT_EQ(merged.gaussianCount(s), a.gaussianCount(s) + b.gaussianCount(s));
    for (const GaussianMap<3>* map : {&a, &b}) {
      for (std::size_t cell = 0; cell < map->cellCount(s); ++cell) {
        const auto found = merged.find(map->scale(s).keys[cell], s);
        ASSERT_TRUE(found);
        const IndexRange old = map->gaussiansOf(cell, s), now = merged.gaussiansOf(*found, s);
        ASSERT_EQ(old.size(), now.size());
        for (std::size_t i = 0; i < old.size(); ++i)
          ASSERT_TRUE(sameGaussian<3>(map->localGaussian(old.first + i, s), merged.localGaussian(now.first + i, s)));
      }
    }
  }
}

TEST(MergeMaps, LeavesAsManyClustersInSharedCellsAsTheLargerCountsAddUpTo) {
  const MapOptions grid = smallGrid<3>();
  const GaussianMap<3> a = refinedMap<3>(randomCloud<3>(8000, 6), grid),
                       b = refinedMap<3>(randomCloud<3>(8000, 7), grid);
  const GaussianMap<3> merged = mergeMaps<3>(a, b);
  std::size_t shared = 0;
  for (int s = 1; s < 3; ++s) {
    std::size_t expected = 0;
    for (std::size_t cell = 0; cell < merged.cellCount(s); ++cell) {
      const CellKey<3>& key = merged.scale(s).keys[cell];
      const auto in_a = a.find(key, s), in_b = b.find(key, s);
      shared += in_a && in_b ? 1 : 0;
      expected += std::max(in_a ? a.gaussiansOf(*in_a, s).size() : 0, in_b ? b.gaussiansOf(*in_b, s).size() : 0);
    }
    EXPECT_EQ(merged.gaussianCount(s), expected);
  }
  EXPECT_GT(shared, 20u);
  expectMomentMatches<3>(merged);
  for (int s = 0; s < 3; ++s) EXPECT_EQ(merged.weight(s), 16000.0);
}

TEST(MergeMaps, IsTheSameForAnyNumberOfThreads) {
  const MapOptions grid = smallGrid<3>();
  const GaussianMap<3> a = refinedMap<3>(randomCloud<3>(8000, 6), grid),
                       b = refinedMap<3>(randomCloud<3>(8000, 7), grid);
  expectSameMap<3>(mergeMaps<3>(a, b, {MergeCost::Volume, 1}), mergeMaps<3>(a, b, {MergeCost::Volume, 2}));
}

/// A map of Gaussians, one scale of cells of 1 m above cells of 0.1 m; means [m, map frame] within one finest cell.
GaussianMap<2> gaussianMap(const std::vector<Gaussian<2>>& gaussians) {
  const MapOptions options = smallGrid<2>(10, 2);
  const Grid<2> grid(options);
  std::vector<MapScale<2>> scales(2);
  const CellKey<2> key = grid.keyOf(gaussians.front().mean);
  scales[0].keys = {key};
  scales[0].first_gaussian = {0, static_cast<std::uint32_t>(gaussians.size())};
  for (Gaussian<2> one : gaussians) {
    one.mean -= grid.centre(key, 0);
    scales[0].gaussians.push_back(one);
  }
  scales[0].parent.assign(gaussians.size(), 0);
  Gaussian<2> all = merge(gaussians);
  scales[1].keys = {grid.ancestor(key, 0, 1)};
  all.mean -= grid.centre(scales[1].keys[0], 1);
  scales[1].gaussians = {all};
  scales[1].first_child = {0, 1};
  return GaussianMap<2>(options, std::move(scales));
}

Gaussian<2> disc(double x, double y, double sigma, double weight) {
  return {{x, y}, sigma * sigma * Matrix<2>::Identity(), weight};
}

TEST(MergeMaps, MatchesTheMomentsOfGaussiansThatMeetInAFinestCell) {
  // 1 : 3 at x = 0.02 and 0.06: mean 0.05; variance 1e-4 + (3 * 0.01^2 + 0.03^2) / 4 = 4e-4
  const GaussianMap<2> a = gaussianMap({disc(0.02, 0.05, 0.01, 1)}), b = gaussianMap({disc(0.06, 0.05, 0.01, 3)});
  const GaussianMap<2> merged = mergeMaps<2>(a, b);
  ASSERT_EQ(merged.gaussianCount(0), 1u);
  for (int s = 0; s < 2; ++s) {
    const Gaussian<2> one = merged.gaussian(0, s);
    EXPECT_EQ(one.weight, 4.0);
    EXPECT_NEAR(one.mean.x(), 0.05, 1e-12);
    EXPECT_NEAR(one.mean.y(), 0.05, 1e-12);
    EXPECT_NEAR(one.cov(0, 0), 4e-4, 1e-15);
    EXPECT_NEAR(one.cov(1, 1), 1e-4, 1e-15);
  }
  EXPECT_FALSE(merged.acceptsScans());
}

TEST(MergeMaps, KeepsAsManyGaussiansInAFinestCellAsTheMapWithMoreHas) {
  const GaussianMap<2> a = gaussianMap({disc(0.01, 0.01, 0.002, 1), disc(0.09, 0.09, 0.002, 1)});
  const GaussianMap<2> b = gaussianMap({disc(0.085, 0.09, 0.002, 2)});
  for (const GaussianMap<2>& merged : {mergeMaps<2>(a, b), mergeMaps<2>(b, a)}) {
    ASSERT_EQ(merged.gaussianCount(0), 2u);
    const Gaussian<2> p = merged.gaussian(0, 0), q = merged.gaussian(1, 0);
    EXPECT_EQ(p.weight + q.weight, 4.0);
    const Gaussian<2>& alone = p.weight < q.weight ? p : q;
    EXPECT_NEAR(alone.mean.x(), 0.01, 1e-12);
  }
}

TEST(MergeMaps, MergesMomentsWithGaussiansAsGaussians) {
  const MapOptions grid = smallGrid<3>();
  const std::vector<Vector<3>> points = randomCloud<3>(4000, 8);
  const GaussianMap<3> a = refinedMap<3>(points, grid);
  Pose motion;
  motion.translation = {0.03, 0.01, -0.02};
  const GaussianMap<3> b = transformMap<3>(refinedMap<3>(randomCloud<3>(4000, 9), grid), motion);
  const GaussianMap<3> merged = mergeMaps<3>(a, b), other_way = mergeMaps<3>(b, a);
  EXPECT_FALSE(merged.acceptsScans());
  expectMomentMatches<3>(merged);
  for (int s = 0; s < 3; ++s)
    expectSameMatch<3>(matchOfScale<3>(merged, s), merge<3>({matchOfScale<3>(a, s), matchOfScale<3>(b, s)}));
  EXPECT_EQ(merged.scale(0).keys, other_way.scale(0).keys);
  for (std::size_t i = 0; i < merged.gaussianCount(0); ++i)
    ASSERT_TRUE(sameGaussian<3>(merged.localGaussian(i, 0), other_way.localGaussian(i, 0)));
}

/// One point in the middle of the finest cell (x, 0).
GaussianMap<2> oneCell(double x, std::optional<float> log_odds) {
  const GaussianMap<2> map = build<2>({{x + 0.05, 0.05}}, smallGrid<2>());
  return log_odds ? withOccupancy<2>(map, {*log_odds}) : map;
}

TEST(MergeMaps, AddsLogOddsWithinTheirBounds) {
  const auto merged = [](std::optional<float> a, std::optional<float> b) {
    return mergeMaps<2>(oneCell(0.0, a), oneCell(0.0, b));
  };
  EXPECT_EQ(merged(1.5f, 2.0f).logOdds(0, 0), 3.5f);
  EXPECT_EQ(merged(1.5f, 2.0f).logOdds(0, 2), 3.5f);  // coarse clusters inherit it
  EXPECT_EQ(merged(8.0f, 7.0f).logOdds(0, 0), kMaxOccupancy);
  EXPECT_EQ(merged(-8.0f, -7.0f).logOdds(0, 0), -kMaxOccupancy);
  EXPECT_EQ(merged(-2.0f, std::nullopt).logOdds(0, 0), -2.0f);  // was asked nothing: adds nothing
  EXPECT_EQ(merged(std::nullopt, -2.0f).logOdds(0, 0), -2.0f);
  EXPECT_FALSE(merged(std::nullopt, std::nullopt).hasOccupancy());
  const GaussianMap<2> beside = mergeMaps<2>(oneCell(0.0, -2.0f), oneCell(0.3, std::nullopt));
  EXPECT_EQ(beside.logOdds(0, 0), -2.0f);
  EXPECT_EQ(beside.logOdds(1, 0), kMaxOccupancy);  // nobody else knows of it
}

TEST(MergeMaps, CombinesLogOddsOfMapsThatHoldGaussiansToo) {
  Pose motion;
  motion.translation = {0.0, 0.01, 0.0};
  const GaussianMap<2> moved = transformMap<2>(oneCell(0.0, 1.0f), motion);
  const GaussianMap<2> merged = mergeMaps<2>(moved, oneCell(0.0, 2.5f));
  ASSERT_EQ(merged.gaussianCount(0), 1u);
  EXPECT_EQ(merged.logOdds(0, 0), 3.5f);
}

TEST(MergeMaps, LosesNothingFarFromTheOrigin) {
  const std::vector<Vector<3>> points = shifted<3>(randomCloud<3>(4000, 3), {1e7, -1e7, 1e7});
  const std::vector<Vector<3>> half(points.begin(), points.begin() + 2000), rest(points.begin() + 2000, points.end());
  const MapOptions grid = smallGrid<3>();
  expectSameMap<3>(mergeMaps<3>(build<3>(half, grid), build<3>(rest, grid)), build<3>(points, grid));
}

TEST(MergeMaps, CountsAMapMergedWithItselfTwice) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(3000, 3), smallGrid<3>());
  const GaussianMap<3> twice = mergeMaps<3>(map, map);
  EXPECT_EQ(twice.scale(0).keys, map.scale(0).keys);
  for (int s = 0; s < 3; ++s) {
    EXPECT_EQ(twice.weight(s), 2.0 * map.weight(s));
    EXPECT_EQ(twice.gaussianCount(s), map.gaussianCount(s));
  }
  expectMomentMatches<3>(twice);
}

void expectRefusal(const GaussianMap<3>& a, const GaussianMap<3>& b, const std::string& word) {
  try {
    mergeMaps<3>(a, b);
    ADD_FAILURE() << "not refused: " << word;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

TEST(MergeMaps, RefusesMapsOfDifferentGrids) {
  const MapOptions grid = smallGrid<3>();
  const GaussianMap<3> map = build<3>({{0, 0, 0}}, grid);
  MapOptions other = grid;
  other.resolution = 0.2;
  expectRefusal(map, GaussianMap<3>(other), "resolutions 0.1 and 0.2");
  other = grid;
  other.ratio = 5;
  expectRefusal(map, GaussianMap<3>(other), "ratios 4 and 5");
  other = grid;
  other.scales = 2;
  expectRefusal(map, GaussianMap<3>(other), "numbers of scales 3 and 2");
  other = grid;
  other.noise = 0.02;
  expectRefusal(map, GaussianMap<3>(other), "noise floors");
}

TEST(MergeMaps, RefusesWhatIsNotThereAndWhatDoesNotFit) {
  const GaussianMap<3> map = build<3>(randomCloud<3>(3000, 3), smallGrid<3>());
  expectRefusal(map, thinned<3>(map), "compressed");
  std::vector<MapScale<3>> scales(1);
  scales[0].keys = {{7, 0, -1}};
  scales[0].moments.resize(1);
  scales[0].moments[0].count = (std::int64_t{1} << 33) - 1;
  const GaussianMap<3> full(smallGrid<3>(4, 1), scales);
  expectRefusal(full, full, "cell (7, 0, -1) would hold 17179869182 points");
}

}  // namespace
}  // namespace gaussmap::test
