// SPDX-License-Identifier: BSD-3-Clause
// compress() and simplify() of planar maps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "editing/ellipsoid.h"
#include "gaussmap/editing/compress.h"
#include "gaussmap/editing/simplify.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/map/sampling.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/gmap/map_equality.h"
#include "map/random_clouds.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::randomCloud;

/// A wall of 10 m at y = 0.05 m, four points per finest cell.
std::vector<Vector<2>> wallPoints() {
  std::vector<Vector<2>> points;
  for (int i = 0; i < 400; ++i) points.emplace_back(0.0125 + 0.025 * i, 0.05);
  return points;
}

double toNearest(const Vector<2>& point, const std::vector<Vector<2>>& points) {
  double square = std::numeric_limits<double>::infinity();
  for (const Vector<2>& other : points) square = std::min(square, (other - point).squaredNorm());
  return std::sqrt(square);
}

TEST(PlanarCompress, LeavesOneGaussianOfAWall) {
  const GaussianMap<2> map = build<2>(wallPoints(), {0.1, 10, 3, 0.0}), small = compress(map, 0.2);
  EXPECT_EQ(small.cellCount(0) + small.cellCount(1), 0u);
  ASSERT_EQ(small.gaussianCount(2), 1u);
  EXPECT_TRUE(test::sameGaussian<2>(small.localGaussian(0, 2), map.localGaussian(0, 2)));
  EXPECT_TRUE(small.isCompressed());
}

TEST(PlanarCompress, KeepsDetailWhereAPostStandsBesideTheWall) {
  std::vector<Vector<2>> points = wallPoints();
  for (int i = 0; i < 20; ++i) points.emplace_back(5.55, 0.75 + 0.001 * i);
  const GaussianMap<2> map = build<2>(points, {0.1, 10, 3, 0.0}), small = compress(map, 0.2);
  EXPECT_EQ(small.cellCount(1), map.cellCount(1));
  for (std::size_t cell = 0; cell < small.cellCount(1); ++cell)
    EXPECT_EQ(small.isLeaf(cell, 1), small.scale(1).keys[cell] != (CellKey<2>{5, 0}));
}

TEST(PlanarCompress, HoldsItsContractForEveryCellThatStandsAlone) {
  std::size_t alone = 0;
  for (std::uint64_t seed = 1; seed < 7; ++seed) {
    GaussianMap<2> whole = build<2>(randomCloud<2>(1500, 90 + seed), {0.1, 2 + int(seed % 4), 3, 0.0});
    if (seed % 2 == 1) whole = refine<2>(whole).map;
    std::vector<Vector<2>> data;
    for (std::size_t i = 0; i < whole.gaussianCount(0); ++i) data.push_back(whole.gaussian(i, 0).mean);
    CompressOptions options;
    options.samples = 50;
    options.seed = seed;
    for (const double max_error : {0.06, 0.1, 0.3}) {
      const GaussianMap<2> small = compress(whole, max_error, options);
      for (int s = 1; s < small.scales(); ++s) {
        SampleOptions sampling;
        sampling.samples = 0;
        sampling.at_least = 50;
        sampling.seed = seed;
        sampling.bounds = SampleBounds::Cell;
        const MapSamples<2> samples = sampleMap<2>(small, s, sampling);
        std::vector<double> near(small.gaussianCount(s), 0.0), placed(near.size(), 0.0);
        for (std::size_t i = 0; i < samples.points.size(); ++i) {
          ++placed[samples.gaussian[i]];
          near[samples.gaussian[i]] += toNearest(samples.points[i], data) <= max_error ? 1.0 : 0.0;
        }
        for (std::size_t g = 0; g < near.size(); ++g) {
          if (!small.isLeaf(small.cellOf(g, s), s)) continue;
          ++alone;
          EXPECT_GE(near[g], 0.95 * placed[g]);
        }
        for (const Vector<2>& datum : data) {
          const auto cell = small.find(small.grid().keyOf(datum, s), s);
          if (!cell || !small.isLeaf(*cell, s)) continue;
          double nearest = std::numeric_limits<double>::infinity();
          const IndexRange range = small.gaussiansOf(*cell, s);
          for (std::size_t g = range.first; g < range.last; ++g)
            nearest = std::min(nearest, Ellipsoid95<2>(small.gaussian(g, s)).distance(datum));
          EXPECT_LE(nearest, max_error);
        }
      }
    }
  }
  EXPECT_GT(alone, 100u);
}

TEST(PlanarCompress, RefusesACompressedMap) {
  const GaussianMap<2> small = compress(build<2>(wallPoints(), {0.1, 10, 3, 0.0}), 0.2);
  EXPECT_THROW(compress(small, 0.2), std::invalid_argument);
}

TEST(Ellipse95, HoldsNineteenOfTwentySamples) {
  Matrix<2> cov;
  cov << 0.09, 0.05, 0.05, 0.04;
  const Gaussian<2> gaussian{{3, -2}, cov, 1.0};
  const Ellipsoid95<2> ellipse(gaussian);
  const GaussianSampler<2> sampler(gaussian);
  Random random(3);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) inside += ellipse.distance(sampler(random)) == 0.0;
  EXPECT_NEAR(inside / 20000.0, 0.95, 0.006);
}

TEST(Ellipse95, OfACircleIsTheDistanceToItsCentreLessTheRadius) {
  const Ellipsoid95<2> disc({{1, 2}, 0.04 * Matrix<2>::Identity(), 1.0});
  EXPECT_NEAR(disc.distance({4, 6}), 5.0 - 0.2 * std::sqrt(-2.0 * std::log(0.05)), 1e-12);
}

// ---- simplify() -----------------------------------------------------------------------------------------------------

TEST(PlanarSimplify, KeepsTheErrorAndTheBytes) {
  const GaussianMap<2> map = refine<2>(build<2>(randomCloud<2>(4000, 4), {0.05, 5, 3, 0.0}), PerCell{4.0}).map;
  MaxError limit{0.08, {}};
  limit.sampling.samples = 2000;
  limit.sampling.data = 5000;
  const RefineResult<2> result = simplify(map, limit);
  EXPECT_LT(result.map.gaussianCount(1), map.gaussianCount(1));
  const std::vector<Vector<2>> data =
      sampleLeaves<2>(map, {limit.sampling.data, 1, SampleShare::Mass, limit.sampling.seed}).points;
  for (int s = 1; s < 3; ++s) {
    std::vector<double> errors;
    for (const Vector<2>& sample :
         sampleMap<2>(result.map, s, {limit.sampling.samples, 1, SampleShare::Volume, limit.sampling.seed}).points)
      errors.push_back(toNearest(sample, data));
    std::sort(errors.begin(), errors.end());
    const double q95 = errors[static_cast<std::size_t>(std::ceil(0.95 * double(errors.size()))) - 1];
    const bool listed = std::any_of(result.not_reached.begin(), result.not_reached.end(),
                                    [&](const NotReached& one) { return one.scale == s; });
    EXPECT_TRUE(q95 <= limit.metres || listed || result.map.gaussianCount(s) == result.map.cellCount(s)) << s;
  }
  const std::uintmax_t all = savedSize<2>(map), least = savedSize<2>(simplify(map, PerCell{1.0}).map);
  const std::uintmax_t most = (all + least) / 2;
  const GaussianMap<2> small = simplify(map, maxFileBytes(most)).map;
  EXPECT_LE(savedSize<2>(small), most);
  EXPECT_GT(savedSize<2>(small), least);
  EXPECT_THROW(simplify(map, maxFileBytes(least - 1)), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
