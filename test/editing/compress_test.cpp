// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/editing/compress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "editing/ellipsoid.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/map/sampling.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/gmap/map_equality.h"
#include "map/inherit_occupancy.h"
#include "map/random_clouds.h"
#include "mapping/room.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::expectSameMap;
using test::randomCloud;

const MapOptions kDecades{0.1, 10, 3, 0.0};

/// A floor of 10 x 10 m at height 0.05 m, four points a finest cell: it fills one cell of 10 m from side to side.
std::vector<Vector<3>> floorPoints(const Vector<3>& shift = Vector<3>::Zero()) {
  std::vector<Vector<3>> points;
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j < 200; ++j) points.push_back(shift + Vector<3>(0.025 + 0.05 * i, 0.025 + 0.05 * j, 0.05));
  return points;
}

std::vector<Vector<3>> polePoints() {
  std::vector<Vector<3>> points;
  for (int i = 0; i < 58; ++i) points.emplace_back(5.55, 5.45, 0.075 + 0.05 * i);
  return points;
}

std::vector<Vector<3>> joined(std::vector<Vector<3>> a, const std::vector<Vector<3>>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// ---- known answers --------------------------------------------------------------------------------------------------

TEST(Compress, LeavesOneGaussianOfAPlane) {
  const GaussianMapOctree map = build<3>(floorPoints(), kDecades);
  const GaussianMapOctree small = compress(map, 0.2);
  EXPECT_EQ(small.cellCount(0), 0u);
  EXPECT_EQ(small.cellCount(1), 0u);
  EXPECT_EQ(small.gaussianCount(2), 1u);
  EXPECT_TRUE(test::sameGaussian<3>(small.localGaussian(0, 2), map.localGaussian(0, 2)));
  EXPECT_TRUE(small.isCompressed());
  EXPECT_FALSE(small.acceptsScans());
  EXPECT_FALSE(small.empty());
  EXPECT_EQ(small.weight(2), 40000.0);
  EXPECT_EQ(small.weight(0), 0.0);
}

TEST(Compress, KeepsDetailWhereAPoleStandsOnThePlane) {
  const GaussianMapOctree map = build<3>(joined(floorPoints(), polePoints()), kDecades);
  const GaussianMapOctree small = compress(map, 0.2);
  EXPECT_EQ(small.cellCount(1), map.cellCount(1));  // the 10 m cell is no good: the pole is not in it
  std::vector<CellKey<3>> detailed;
  for (std::size_t cell = 0; cell < small.cellCount(1); ++cell)
    if (!small.isLeaf(cell, 1)) detailed.push_back(small.scale(1).keys[cell]);
  EXPECT_EQ(detailed, (std::vector<CellKey<3>>{{5, 5, 0}}));  // floor and pole in one Gaussian; above it is a line
  EXPECT_EQ(small.cellCount(0), map.childCells(*map.find({5, 5, 0}, 1), 1).size());
}

TEST(Compress, MissesNoObjectHoweverFewItsPoints) {
  for (const Vector<3>& lone : {Vector<3>(5.05, 5.05, 4.05), Vector<3>(0.05, 9.95, 9.95)}) {
    const GaussianMapOctree map = build<3>(joined(floorPoints(), {lone}), kDecades);
    const GaussianMapOctree small = compress(map, 0.3);
    EXPECT_TRUE(small.find(small.grid().keyOf(lone, 1), 1)) << "one point in 40000 may not vanish";
  }
}

TEST(Compress, KeepsTheCornerThatOneGaussianBridges) {
  std::vector<Vector<3>> points;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) {
      const double a = 0.0125 + 0.025 * i, b = 0.0125 + 0.025 * j;
      points.emplace_back(a, 0.05, b);
      points.emplace_back(0.05, a, b);
      points.emplace_back(2.05, a, b);  // a wall in a cell of its own
    }
  const GaussianMapOctree small = compress(build<3>(points, {0.1, 10, 2, 0.0}), 0.15);
  ASSERT_EQ(small.cellCount(1), 2u);
  EXPECT_FALSE(small.isLeaf(*small.find({0, 0, 0}, 1), 1));
  EXPECT_TRUE(small.isLeaf(*small.find({2, 0, 0}, 1), 1));
}

TEST(Compress, WithSeveralGaussiansACellLetsTheCornerGo) {
  std::vector<Vector<3>> points;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) {
      points.emplace_back(0.0125 + 0.025 * i, 0.05, 0.0125 + 0.025 * j);
      points.emplace_back(0.05, 0.0125 + 0.025 * i, 0.0125 + 0.025 * j);
    }
  const GaussianMapOctree map = refine<3>(build<3>(points, {0.1, 10, 2, 0.0})).map;
  EXPECT_EQ(compress(map, 0.15).cellCount(0), 0u);
}

TEST(Compress, DeletesNothingForATinyError) {
  for (const double max_error : {1e-9, 1e-3}) {
    Random random(1);
    const GaussianMapOctree map = refine<3>(build<3>(roomPoints(random, 20000), kDecades)).map;
    const GaussianMapOctree same = compress(map, max_error);
    expectSameMap<3>(same, map);
    EXPECT_FALSE(same.isCompressed());
    EXPECT_TRUE(same.acceptsScans());
  }
}

TEST(Compress, LeavesTheCoarsestScaleForAHugeError) {
  Random random(2);
  const GaussianMapOctree map = refine<3>(build<3>(roomPoints(random, 20000), kDecades)).map;
  const GaussianMapOctree small = compress(map, 100.0);
  EXPECT_EQ(small.cellCount(0) + small.cellCount(1), 0u);
  EXPECT_EQ(small.gaussianCount(2), map.gaussianCount(2));
}

TEST(Compress, LeavesEveryPointOnceAtTheScaleWhereDetailEnds) {
  const GaussianMapOctree map =
      build<3>(joined(joined(floorPoints(), polePoints()), floorPoints({20.0, -10.0, 0.0})), kDecades);
  const GaussianMapOctree small = compress(map, 0.2);
  const LeafCounts fine = leafCounts<3>(small, 0), middle = leafCounts<3>(small, 1), coarse = leafCounts<3>(small, 2);
  EXPECT_EQ(fine.weight, 400.0 + 19.0);      // a square metre of floor and the pole's foot
  EXPECT_EQ(middle.weight, 39600.0 + 39.0);  // the rest of both
  EXPECT_EQ(coarse.weight, 40000.0);         // the other floor
  EXPECT_EQ(middle.cells, 99u + 2u);
  EXPECT_EQ(coarse.cells, 1u);
}

// ---- the contract ---------------------------------------------------------------------------------------------------

/// Distance to the nearest of some points, by looking at all.
double distanceToNearest(const Vector<3>& point, const std::vector<Vector<3>>& points) {
  double square = std::numeric_limits<double>::infinity();
  for (const Vector<3>& other : points) square = std::min(square, (other - point).squaredNorm());
  return std::sqrt(square);
}

std::vector<Vector<3>> finestMeans(const GaussianMapOctree& map) {
  std::vector<Vector<3>> means;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) means.push_back(map.gaussian(i, 0).mean);
  return means;
}

SampleOptions samplesOfTheContract(const CompressOptions& options) {
  SampleOptions samples;
  samples.samples = 0;
  samples.at_least = options.samples;
  samples.seed = options.seed;
  samples.bounds = SampleBounds::Cell;
  return samples;
}

/// Is every Gaussian of a cell near the data, and every datum under it near one of them? By the words of the header.
std::vector<bool> goodCells(const GaussianMapOctree& shown, const GaussianMapOctree& whole, int s, double max_error,
                            const CompressOptions& options) {
  const std::vector<Vector<3>> data = finestMeans(whole);
  std::vector<int> near(shown.gaussianCount(s), 0), placed(shown.gaussianCount(s), 0);
  const MapSamples<3> samples = sampleMap<3>(shown, s, samplesOfTheContract(options));
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    ++placed[samples.gaussian[i]];
    near[samples.gaussian[i]] += distanceToNearest(samples.points[i], data) <= max_error;
  }
  std::vector<bool> good(shown.cellCount(s), true);
  for (std::size_t g = 0; g < near.size(); ++g)
    if (near[g] < 0.95 * placed[g] - 1e-9) good[shown.cellOf(g, s)] = false;
  for (const Vector<3>& datum : data) {
    const auto cell = shown.find(shown.grid().keyOf(datum, s), s);
    if (!cell) continue;
    double nearest = std::numeric_limits<double>::infinity();
    const IndexRange range = shown.gaussiansOf(*cell, s);
    for (std::size_t g = range.first; g < range.last; ++g)
      nearest = std::min(nearest, Ellipsoid95<3>(shown.gaussian(g, s)).distance(datum));
    if (nearest > max_error) good[*cell] = false;
  }
  return good;
}

class CompressProperty : public testing::TestWithParam<std::uint64_t> {
 protected:
  CompressProperty() : whole_(build<3>(randomCloud<3>(1500, 90 + GetParam()), {0.1, 2 + int(GetParam() % 4), 3, 0.0})) {
    if (GetParam() % 2 == 1) whole_ = refine<3>(whole_).map;
    options_.samples = GetParam() % 3 == 0 ? 100 : 30;
    options_.seed = GetParam();
  }
  GaussianMapOctree whole_;
  CompressOptions options_;
};

TEST_P(CompressProperty, HoldsItsContractForEveryCellThatStandsAlone) {
  for (const double max_error : {0.06, 0.1, 0.2, 0.5}) {
    const GaussianMapOctree small = compress(whole_, max_error, options_);
    for (int s = 1; s < small.scales(); ++s) {
      const std::vector<bool> good = goodCells(small, whole_, s, max_error, options_);
      for (std::size_t cell = 0; cell < small.cellCount(s); ++cell)
        EXPECT_TRUE(good[cell] || !small.isLeaf(cell, s)) << "scale " << s << ", max_error " << max_error;
    }
  }
}

TEST_P(CompressProperty, KeepsNothingFinerUnderAGoodCell) {
  std::size_t alone = 0, detailed = 0;
  for (const double max_error : {0.06, 0.1, 0.2, 0.5}) {
    const GaussianMapOctree small = compress(whole_, max_error, options_);
    for (int s = 1; s < small.scales(); ++s) {
      const std::vector<bool> good = goodCells(small, whole_, s, max_error, options_);
      for (std::size_t cell = 0; cell < small.cellCount(s); ++cell) {
        EXPECT_EQ(small.isLeaf(cell, s), good[cell]);
        (good[cell] ? alone : detailed) += 1;
        const std::size_t children = whole_.childCells(*whole_.find(small.scale(s).keys[cell], s), s).size();
        EXPECT_EQ(small.childCells(cell, s).size(), good[cell] ? 0 : children);  // all or none
      }
    }
  }
  EXPECT_GT(alone, 0u);
  EXPECT_GT(detailed, 0u);
}

TEST_P(CompressProperty, DeletesMoreTheLargerTheError) {
  std::size_t before = std::numeric_limits<std::size_t>::max();
  for (const double max_error : {0.01, 0.05, 0.1, 0.2, 0.5, 2.0}) {
    const std::size_t now = leaves<3>(compress(whole_, max_error, options_)).size();
    EXPECT_LE(now, before);
    before = now;
  }
}

TEST_P(CompressProperty, DoesNotDependOnThreads) {
  CompressOptions one = options_, two = options_;
  one.threads = 1;
  two.threads = 2;
  const GaussianMapOctree small = compress(whole_, 0.1, one);
  expectSameMap<3>(compress(whole_, 0.1, two), small);
  expectSameMap<3>(compress(whole_, 0.1, options_), small);
}

INSTANTIATE_TEST_SUITE_P(RandomClouds, CompressProperty, testing::Range<std::uint64_t>(0, 6));

// ---- by the error of the cells
// ---------------------------------------------------------------------------------------

TEST(CompressByCellError, ComparesEquationSix) {
  // Two points, 0.1 m apart. Their Gaussians have the noise floor of 5 mm, and the coarse mean is 0.05 m from both:
  // E = (0.05 / 0.005)^2 = 100.
  const GaussianMapOctree map = build<3>({{0.05, 0.05, 0.05}, {0.15, 0.05, 0.05}}, {0.1, 10, 2, 0.0});
  const CompressOptions paper = CompressOptions::yguel2009();
  expectSameMap<3>(compress(map, 99.9, paper), map);
  EXPECT_EQ(compress(map, 100.1, paper).cellCount(0), 0u);
  EXPECT_THROW(compress(map, 0.0, paper), std::invalid_argument);
  EXPECT_THROW(compress(map, HUGE_VAL, paper), std::invalid_argument);
}

TEST(CompressByCellError, OfThePaperMultipliesByOneMinusTheLearningRate) {  // 1 - 5e-2 for a free cell: E = 95
  GaussianMapOctree map = build<3>({{0.05, 0.05, 0.05}, {0.15, 0.05, 0.05}}, {0.1, 10, 2, 0.0});
  map = withOccupancy<3>(map, {-10.0f, -10.0f});
  CompressOptions options = CompressOptions::yguel2009();
  EXPECT_EQ(compress(map, 95.1, options).cellCount(0), 0u);
  EXPECT_EQ(compress(map, 94.9, options).cellCount(0), 2u);
  options.learning_factor = false;
  EXPECT_EQ(compress(map, 95.1, options).cellCount(0), 2u);
}

/// True if eq. (6) of this cell and of all coarse cells below it is at most the limit.
bool isGood(const GaussianMapOctree& map, std::size_t cell, int s, double limit) {
  if (s == 0) return true;
  const IndexRange clusters = map.gaussiansOf(cell, s), under = map.gaussiansUnder(cell, s);
  double sum = 0.0;
  for (std::size_t j = under.first; j < under.last; ++j) {
    const Gaussian<3> z = map.gaussian(j, s - 1);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = clusters.first; i < clusters.last; ++i) {
      const Vector<3> apart = map.gaussian(i, s).mean - z.mean;
      nearest = std::min(nearest, apart.dot(z.cov.inverse() * apart));
    }
    sum += nearest;
  }
  if (sum > limit * static_cast<double>(under.size())) return false;
  const IndexRange children = map.childCells(cell, s);
  for (std::size_t child = children.first; child < children.last; ++child)
    if (!isGood(map, child, s - 1, limit)) return false;
  return true;
}

TEST(CompressByCellError, KeepsDetailExactlyWhereTheErrorIsLarge) {
  Random random(4);
  const GaussianMapOctree map = refine<3>(build<3>(roomPoints(random, 20000), {0.1, 4, 3, 0.0})).map;
  std::size_t alone = 0, detailed = 0;
  for (const double limit : {3.0, 10.0, 30.0, 100.0}) {
    const GaussianMapOctree small = compress(map, limit, CompressOptions::yguel2009());
    for (int s = 1; s < 3; ++s) {
      for (std::size_t cell = 0; cell < small.cellCount(s); ++cell) {
        const bool is_good = isGood(map, *map.find(small.scale(s).keys[cell], s), s, limit);
        ASSERT_EQ(small.isLeaf(cell, s), is_good) << "scale " << s << ", limit " << limit;
        ++(is_good ? alone : detailed);
      }
    }
  }
  EXPECT_GT(alone, 50u);
  EXPECT_GT(detailed, 50u);
}

// ---- hostile input --------------------------------------------------------------------------------------------------

TEST(Compress, TakesMapsOfNothingOnePointAndOneScale) {
  expectSameMap<3>(compress(GaussianMapOctree(), 0.1), GaussianMapOctree());
  const GaussianMapOctree flat = build<3>(randomCloud<3>(300, 82), {0.1, 10, 1, 0.0});
  expectSameMap<3>(compress(flat, 10.0), flat);
  const GaussianMapOctree point = build<3>({{1.25, -3.5, 0.0}}, kDecades);
  const GaussianMapOctree small = compress(point, 0.1);
  EXPECT_EQ(small.cellCount(0) + small.cellCount(1), 0u);  // its coarse Gaussian is as good as the finest
  EXPECT_EQ(small.weight(2), 1.0);
  EXPECT_FALSE(compress(point, 1e-4).isCompressed());  // but for a noise floor of 5 mm
}

TEST(Compress, TakesManyEqualPoints) {
  const GaussianMapOctree map = build<3>(std::vector<Vector<3>>(5000, {0.5, 0.5, 0.5}), kDecades);
  EXPECT_EQ(compress(map, 0.1).cellCount(0), 0u);
}

TEST(Compress, FarFromTheOriginDoesTheSame) {
  for (const Vector<3>& shift : {Vector<3>(1e7, -1e7, 1e7), Vector<3>(-2e6, 3e5, 0.0)}) {
    std::vector<Vector<3>> points = joined(floorPoints(), polePoints());
    for (Vector<3>& point : points) point += shift;
    const GaussianMapOctree small = compress(build<3>(points, kDecades), 0.2);
    const CellKey<3> foot = small.grid().keyOf(shift + Vector<3>(5.55, 5.45, 0.05), 1);
    for (std::size_t cell = 0; cell < small.cellCount(1); ++cell)
      EXPECT_EQ(small.isLeaf(cell, 1), small.scale(1).keys[cell] != foot);
    EXPECT_EQ(small.cellCount(1), 102u);
  }
}

TEST(Compress, TakesMapsWithoutMoments) {
  const GaussianMapOctree map = build<3>(floorPoints(), kDecades);
  MapScale<3> finest;
  finest.keys = map.scale(0).keys;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) finest.gaussians.push_back(map.localGaussian(i, 0));
  EXPECT_EQ(compress(build<3>(finest, kDecades), 0.2).cellCount(1), 0u);
}

TEST(Compress, RefusesErrorsThatMakeNoSense) {
  const GaussianMapOctree map = build<3>({{0, 0, 0}}, kDecades);
  for (const double max_error :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(compress(map, max_error), std::invalid_argument) << max_error;
  CompressOptions none;
  none.samples = 0;
  EXPECT_THROW(compress(map, 0.1, none), std::invalid_argument);
}

TEST(Compress, RefusesACompressedMapAndSoDoesRefine) {
  const GaussianMapOctree small = compress(build<3>(floorPoints(), kDecades), 0.2);
  EXPECT_THROW(compress(small, 0.2), std::invalid_argument);
  EXPECT_THROW(refine<3>(small), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
