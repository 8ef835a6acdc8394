// SPDX-License-Identifier: BSD-3-Clause
// A compressed map is evaluated as a whole: its finest cells, and the coarse ones that stand alone.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "editing/thinned_map.h"
#include "gaussmap/evaluation/hausdorff.h"
#include "gaussmap/evaluation/held_out.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/random_clouds.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::randomCloud;

constexpr double kNothing = -std::numeric_limits<double>::infinity();

GaussianMapOctree wholeMap() {
  return refine<3>(build<3>(randomCloud<3>(4000, 61), {0.1, 4, 3, 0.0})).map;
}

GaussianMapOctree smallMap() {
  return test::thinned(wholeMap());
}

/// 4000 points on a square metre of floor, in one cell of 1 m; nothing finer if `bare`.
GaussianMapOctree floorMap(bool bare) {
  Random random(62);
  std::vector<Vector<3>> points;
  for (int i = 0; i < 4000; ++i) points.emplace_back(random.uniform(), random.uniform(), 0.45);
  const GaussianMapOctree map = build<3>(points, {0.1, 10, 2, 0.0});
  return bare ? keepCells<3>(map, {std::vector<char>(map.cellCount(0), false), {true}}) : map;
}

TEST(CompressedMapEvaluation, HasLeavesAtEveryScaleToTestWith) {
  const GaussianMapOctree map = smallMap();
  for (int s = 0; s < 3; ++s) EXPECT_GT(leafCounts<3>(map, s).gaussians, 0u) << s;
}

TEST(CompressedMapEvaluation, SamplesEveryLeafInItsCell) {
  const GaussianMapOctree map = smallMap();
  const std::vector<GaussianId> all = leaves<3>(map);
  SampleOptions options;
  options.samples = 20000;
  const MapSamples<3> samples = sampleLeaves<3>(map, options);
  std::vector<std::size_t> counts(all.size(), 0);
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    ++counts[samples.gaussian[i]];
    const auto [scale, index] = all[samples.gaussian[i]];
    EXPECT_EQ(map.grid().keyOf(samples.points[i], scale), map.scale(scale).keys[map.cellOf(index, scale)]);
  }
  for (const std::size_t count : counts) EXPECT_GE(count, options.at_least);
}

TEST(CompressedMapEvaluation, SharesSamplesOutByWeightOverAllScales) {
  const GaussianMapOctree map = smallMap();
  SampleOptions options;
  options.samples = 40000;
  options.at_least = 0;
  options.share = SampleShare::Mass;
  std::vector<std::size_t> counts(leaves<3>(map).size(), 0);
  for (const std::uint32_t leaf : sampleLeaves<3>(map, options).gaussian) ++counts[leaf];
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const GaussianId id = leaves<3>(map)[i];
    EXPECT_EQ(counts[i], std::lround(10.0 * map.localGaussian(id.index, id.scale).weight));  // 4000 points
  }
}

TEST(CompressedMapEvaluation, OfAMapThatIsNotCompressedIsThatOfItsFinestScale) {
  const GaussianMapOctree map = wholeMap();
  const std::vector<Vector<3>> points = randomCloud<3>(500, 63);
  EXPECT_EQ(sampleLeaves<3>(map).points, sampleMap<3>(map, 0).points);
  EXPECT_EQ(sampleLeaves<3>(map).gaussian, sampleMap<3>(map, 0).gaussian);
  EXPECT_EQ(logLikelihoods<3>(map, points), logLikelihoods<3>(map, 0, points));
  EXPECT_EQ(logLikelihood<3>(map, points[0]), logLikelihood<3>(map, points[0], 0));
  const Reference reference(points);
  EXPECT_EQ(reference.compareLeaves(map).all.hausdorff(), reference.compare(map, 0).all.hausdorff());
  EXPECT_EQ(reference.compareLeaves(map).gaussians, map.gaussianCount(0));
}

TEST(CompressedMapEvaluation, ComparesAllLeaves) {
  const Reference far({{10.5, 0.5, 0.45}});
  const MapHausdorff bare = far.compareLeaves(floorMap(true)), whole = far.compareLeaves(floorMap(false));
  EXPECT_EQ(bare.gaussians, 1u);
  EXPECT_NEAR(bare.all.forward.mean, 10.0, 0.05);
  EXPECT_NEAR(whole.all.forward.mean, 10.0, 0.05);
  EXPECT_THROW(far.compare(floorMap(true), 0), std::invalid_argument);  // nothing at its finest scale
  EXPECT_THROW(far.compareLeaves(GaussianMapOctree()), std::invalid_argument);
}

/// The mixture of all leaves whose cell is at most one away from the point's, term by term.
double logLikelihoodByLooking(const GaussianMapOctree& map, const Vector<3>& point) {
  double sum = 0.0;
  for (const auto& [scale, index] : leaves<3>(map)) {
    const CellKey<3> here = map.grid().keyOf(point, scale), there = map.scale(scale).keys[map.cellOf(index, scale)];
    bool near = true;
    for (std::size_t axis = 0; axis < 3; ++axis) near &= std::abs(here[axis] - there[axis]) <= 1;
    const Gaussian<3> gaussian = map.gaussian(index, scale);
    if (near) sum += gaussian.weight * std::exp(logDensity<3>(point, gaussian));
  }
  return std::log(sum / 4000.0);
}

TEST(CompressedMapEvaluation, ForetellsPointsWithTheMixtureOfItsLeaves) {
  const GaussianMapOctree map = smallMap();
  std::vector<Vector<3>> points = randomCloud<3>(300, 64);
  points.emplace_back(100.0, 0.0, 0.0);
  const std::vector<double> all = logLikelihoods<3>(map, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double expected = logLikelihoodByLooking(map, points[i]), single = logLikelihood<3>(map, points[i]);
    if (expected == kNothing || expected < -600.0) continue;  // e^-700 is 0
    EXPECT_NEAR(all[i], expected, 1e-9 * std::abs(expected));
    EXPECT_NEAR(single, expected, 1e-9 * std::abs(expected));
  }
  EXPECT_EQ(all.back(), kNothing);
  EXPECT_EQ(logLikelihood<3>(map, points.back()), kNothing);
  EXPECT_EQ(logLikelihoods<3>(map, points, 1), logLikelihoods<3>(map, points, 2));
}

TEST(CompressedMapEvaluation, ForetellsPointsWhereOnlyTheCoarseCellIsLeft) {
  const GaussianMapOctree map = floorMap(true);
  const Vector<3> point(0.3, 0.6, 0.45);
  EXPECT_EQ(logLikelihood<3>(map, point, 0), kNothing);
  EXPECT_NEAR(logLikelihood<3>(map, point), logDensity<3>(point, map.gaussian(0, 1)), 1e-12);
  const HeldOutResult held_out = heldOutLogLikelihood<3>(map, {point, {50.0, 0.0, 0.0}, {1.5, 0.5, 0.5}});
  EXPECT_EQ(held_out.count, 3u);
  EXPECT_EQ(held_out.in_no_cell, 2u);
  EXPECT_EQ(held_out.nowhere, 1u);
  EXPECT_THROW(heldOutLogLikelihood<3>(map, std::vector<Vector<3>>()), std::invalid_argument);
}

TEST(CompressedMapEvaluation, FindsNormalsAndMeansWhereThereIsNoFinestCell) {
  const GaussianMapOctree map = floorMap(true);
  EXPECT_FALSE(nearest<3>(map, {0.5, 0.5, 0.5}, 0));
  ASSERT_TRUE(nearest<3>(map, {9.5, 0.5, 0.45}, 1));
  EXPECT_NEAR(nearest<3>(map, {9.5, 0.5, 0.45}, 1)->distance, 9.0, 0.05);
  const auto normal = normalAt<3>(map, {0.5, 0.5, 0.45});
  ASSERT_TRUE(normal);
  EXPECT_NEAR(std::abs(normal->z()), 1.0, 1e-6);
}

TEST(CompressedMapEvaluation, FindsTheNearestGaussianOfAnIncompleteScale) {
  const GaussianMapOctree map = smallMap();
  for (const Vector<3>& point : randomCloud<3>(200, 65))
    for (int s = 0; s < 3; ++s) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < map.gaussianCount(s); ++i)
        least = std::min(least, (map.gaussian(i, s).mean - point).norm());
      const auto found = nearest<3>(map, point, s);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->distance, least, 1e-12);
    }
}

}  // namespace
}  // namespace gaussmap
