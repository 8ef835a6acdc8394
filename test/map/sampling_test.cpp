// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/editing/compress.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"

namespace gaussmap {
namespace {

const Matrix<3> kIdentity = Matrix<3>::Identity();

/// A map with one scale of cells 1 m wide: one Gaussian each, given about the cell's centre. Keys in order.
GaussianMap<3> mapOf(const std::vector<CellKey<3>>& keys, const std::vector<Gaussian<3>>& gaussians) {
  MapScale<3> scale;
  scale.keys = keys;
  scale.gaussians = gaussians;
  return GaussianMap<3>(MapOptions{1.0, 10, 1, 0.01}, {scale});
}

template <int D>
GaussianMap<D> randomMap(double far = 0.0, std::size_t count = 3000) {
  Random random(5);
  std::vector<Vector<D>> points(count);
  for (Vector<D>& point : points)
    for (int axis = 0; axis < D; ++axis) point(axis) = far + random.uniform();
  return build<D>(points, MapOptions{0.1, 4, 3, 0.01});
}

template <int D>
bool equalBytes(const MapSamples<D>& a, const MapSamples<D>& b) {
  return a.points.size() == b.points.size() && a.gaussian == b.gaussian && a.mahalanobis == b.mahalanobis &&
         std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Vector<D>)) == 0;
}

std::size_t samplesOf(const MapSamples<3>& samples, std::uint32_t gaussian) {
  return static_cast<std::size_t>(std::count(samples.gaussian.begin(), samples.gaussian.end(), gaussian));
}

template <int D>
void expectSamplesInTheirCells(double far) {
  const GaussianMap<D> map = randomMap<D>(far);
  for (int scale = 0; scale < map.scales(); ++scale) {
    const MapSamples<D> samples = sampleMap(map, scale);
    ASSERT_EQ(samples.points.size(), samples.gaussian.size());
    ASSERT_EQ(samples.points.size(), samples.mahalanobis.size());
    for (std::size_t i = 0; i < samples.points.size(); ++i) {
      const CellKey<D>& key = map.scale(scale).keys[map.cellOf(samples.gaussian[i], scale)];
      ASSERT_EQ(map.grid().keyOf(samples.points[i], scale), key) << "sample " << i << " of scale " << scale;
    }
  }
}
TEST(SampleMap, KeepsSamplesInTheirCellsIn2D) {
  expectSamplesInTheirCells<2>(0.0);
}
TEST(SampleMap, KeepsSamplesInTheirCellsIn3D) {
  expectSamplesInTheirCells<3>(0.0);
}
TEST(SampleMap, KeepsSamplesInTheirCellsTenThousandKilometresAway) {
  expectSamplesInTheirCells<3>(-1e7);
}

/// Keys of the finest cells under every Gaussian of a scale: the smallest and the largest on each axis.
template <int D>
std::vector<std::pair<CellKey<D>, CellKey<D>>> memberKeys(const GaussianMap<D>& map, int scale) {
  constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
  CellKey<D> none_low, none_high;
  none_low.fill(kMax);
  none_high.fill(-kMax);
  std::vector<std::pair<CellKey<D>, CellKey<D>>> ranges(map.gaussianCount(scale), {none_low, none_high});
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) {
    std::size_t cluster = i;
    for (int s = 0; s < scale; ++s) cluster = map.parentOf(cluster, s);
    const CellKey<D>& key = map.scale(0).keys[map.cellOf(i, 0)];
    for (std::size_t axis = 0; axis < D; ++axis) {
      ranges[cluster].first[axis] = std::min(ranges[cluster].first[axis], key[axis]);
      ranges[cluster].second[axis] = std::max(ranges[cluster].second[axis], key[axis]);
    }
  }
  return ranges;
}

/// How many samples of a scale lie outside the box of their Gaussian's finest cells.
template <int D>
std::size_t samplesOutsideMembers(const GaussianMap<D>& map, int scale, const MapSamples<D>& samples) {
  const auto ranges = memberKeys<D>(map, scale);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const CellKey<D> key = map.grid().keyOf(samples.points[i]);
    const auto& [low, high] = ranges[samples.gaussian[i]];
    bool inside = true;
    for (std::size_t axis = 0; axis < D; ++axis) inside &= low[axis] <= key[axis] && key[axis] <= high[axis];
    outside += inside ? 0 : 1;
  }
  return outside;
}

template <int D>
void expectSamplesAmongTheMembers(double far) {
  const GaussianMap<D> map = refine<D>(randomMap<D>(far, 300)).map;
  SampleOptions in_cells;
  in_cells.bounds = SampleBounds::Cell;
  for (int scale = 1; scale < map.scales(); ++scale) {
    const MapSamples<D> samples = sampleMap(map, scale);
    EXPECT_GT(samples.points.size(), 99 * (samples.points.size() + samples.unplaced) / 100);
    EXPECT_EQ(samplesOutsideMembers<D>(map, scale, samples), 0u) << "scale " << scale;
    EXPECT_GT(samplesOutsideMembers<D>(map, scale, sampleMap(map, scale, in_cells)), 100u) << "scale " << scale;
  }
}
TEST(SampleMap, KeepsSamplesAmongTheirMembersIn2D) {
  expectSamplesAmongTheMembers<2>(0.0);
}
TEST(SampleMap, KeepsSamplesAmongTheirMembersIn3D) {
  expectSamplesAmongTheMembers<3>(0.0);
}
TEST(SampleMap, KeepsSamplesAmongTheirMembersTenThousandKilometresAway) {
  expectSamplesAmongTheMembers<3>(-1e7);
}

TEST(SampleMap, HasTheCellsAsBoundsAtTheFinestScale) {
  const GaussianMap<3> map = randomMap<3>();
  SampleOptions options;
  options.bounds = SampleBounds::Cell;
  EXPECT_TRUE(equalBytes(sampleMap(map, 0), sampleMap(map, 0, options)));
  EXPECT_FALSE(equalBytes(sampleMap(map, 1), sampleMap(map, 1, options)));
}

TEST(SampleMap, FillsTheCellWhereTheDetailWasDeleted) {
  Random random(9);
  std::vector<Vector<3>> ball;  // in the middle of the 10 m cell around (5, 5, 5), as wide as a Gaussian fits in
  for (int i = 0; i < 3000; ++i)
    ball.push_back(Vector<3>::Constant(5.0) + 1.2 * Vector<3>(random.normal(), random.normal(), random.normal()));
  const GaussianMap<3> map = build<3>(ball, MapOptions{1.0, 10, 2, 0.01});
  const GaussianMap<3> compressed = compress(map, 5.0);
  ASSERT_TRUE(compressed.isCompressed());
  SampleOptions in_cells;
  in_cells.bounds = SampleBounds::Cell;
  EXPECT_TRUE(equalBytes(sampleMap(compressed, 1), sampleMap(map, 1, in_cells)));
  EXPECT_FALSE(equalBytes(sampleMap(compressed, 1), sampleMap(map, 1)));
  EXPECT_TRUE(sampleMap(compressed, 0).points.empty());
}

TEST(SampleMap, GivesTheSameBytesWithAnyNumberOfThreads) {
  const GaussianMap<3> map = randomMap<3>();
  SampleOptions options;
  options.threads = 1;
  const MapSamples<3> one = sampleMap(map, 0, options);
  for (const int threads : {2, 0}) {
    options.threads = threads;
    EXPECT_TRUE(equalBytes(one, sampleMap(map, 0, options))) << threads << " threads";
  }
  options.seed = 2;
  EXPECT_FALSE(equalBytes(one, sampleMap(map, 0, options)));
}

TEST(SampleMap, SharesSamplesOutByTheVolumeOfTheEllipsoids) {  // sigma 0.02 and 0.04: volumes 1 : 8
  const GaussianMap<3> map = mapOf({{0, 0, 0}, {1, 0, 0}}, {{{0, 0, 0}, 0.0004 * kIdentity, 900.0},  //
                                                            {{0, 0, 0}, 0.0016 * kIdentity, 100.0}});
  SampleOptions options;
  options.samples = 9000;
  EXPECT_EQ(sampleCounts(map, 0, options), (std::vector<std::size_t>{1000, 8000}));
  const MapSamples<3> by_volume = sampleMap(map, 0, options);
  EXPECT_EQ(samplesOf(by_volume, 0), 1000u);
  EXPECT_EQ(samplesOf(by_volume, 1), 8000u);
  options.share = SampleShare::Mass;  // weights 9 : 1
  EXPECT_EQ(sampleCounts(map, 0, options), (std::vector<std::size_t>{8100, 900}));
}

TEST(SampleMap, GivesEveryGaussianItsMinimum) {
  const GaussianMap<3> map = mapOf({{0, 0, 0}, {1, 0, 0}}, {{{0, 0, 0}, 1e-10 * kIdentity, 1.0},  //
                                                            {{0, 0, 0}, 0.0025 * kIdentity, 1.0}});
  SampleOptions options;
  options.samples = 500;
  EXPECT_EQ(sampleCounts(map, 0, options), (std::vector<std::size_t>{30, 500}));
  options.at_least = 0;
  EXPECT_EQ(sampleCounts(map, 0, options), (std::vector<std::size_t>{0, 500}));
  options.samples = 0;
  EXPECT_TRUE(sampleMap(map, 0, options).points.empty());
}

TEST(SampleMap, OfThePaperSharesWithoutAMinimumAndFillsTheCell) {  // volumes 1 : 8 : 1e6
  const GaussianMap<3> map =
      mapOf({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
            {{{0, 0, 0}, 4e-6 * kIdentity, 5}, {{0, 0, 0}, 16e-6 * kIdentity, 1}, {{0, 0, 0}, 0.04 * kIdentity, 1}});
  SampleOptions options = SampleOptions::yguel2009();
  options.samples = 100000;
  EXPECT_EQ(sampleCounts<3>(map, 0, options), (std::vector<std::size_t>{0, 1, 99999}));
  const GaussianMap<3> coarse = randomMap<3>();
  SampleOptions in_cell;
  in_cell.bounds = SampleBounds::Cell;
  in_cell.at_least = 0;
  EXPECT_TRUE(equalBytes(sampleMap(coarse, 2, SampleOptions::yguel2009()), sampleMap(coarse, 2, in_cell)));
  EXPECT_FALSE(equalBytes(sampleMap(coarse, 2), sampleMap(coarse, 2, in_cell)));
}

TEST(SampleMap, HasTheMomentsOfAGaussianWellInsideItsCell) {
  Gaussian<3> gaussian{{0.1, -0.05, 0.02}, kIdentity, 1.0};
  gaussian.cov << 0.0025, 0.0010, 0.0, 0.0010, 0.0016, -0.0003, 0.0, -0.0003, 0.0009;  // 8 sigma to the border
  SampleOptions options;
  options.samples = 200000;
  const GaussianMap<3> map = mapOf({{3, -2, 7}}, {gaussian});
  const MapSamples<3> samples = sampleMap(map, 0, options);
  ASSERT_EQ(samples.points.size(), options.samples);
  const Vector<3> expected = Vector<3>(3.5, -1.5, 7.5) + gaussian.mean;
  Vector<3> mean = Vector<3>::Zero();
  Matrix<3> cov = Matrix<3>::Zero();
  double within_one = 0.0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Vector<3> offset = samples.points[i] - expected;
    mean += offset / double(options.samples);
    cov += offset * offset.transpose() / double(options.samples);
    within_one += (samples.mahalanobis[i] <= 1.0) / double(options.samples);
    ASSERT_NEAR(std::pow(samples.mahalanobis[i], 2), mahalanobisSquared<3>(samples.points[i], map.gaussian(0, 0)),
                1e-9);
  }
  EXPECT_LT(mean.norm(), 4 * std::sqrt(gaussian.cov.trace() / double(options.samples)));
  EXPECT_LT((cov - gaussian.cov).norm(), 0.02 * gaussian.cov.norm());
  EXPECT_NEAR(within_one, 0.198748, 0.004);  // chi distribution with 3 degrees of freedom
}

TEST(SampleMap, TruncatesByFilteringTheSameSamples) {
  const GaussianMap<3> map = randomMap<3>();
  const MapSamples<3> samples = sampleMap(map, 1);
  const std::vector<Vector<3>> near = samples.within(2.0);
  std::size_t next = 0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    if (samples.mahalanobis[i] > 2.0) continue;
    ASSERT_EQ(samples.points[i], near.at(next++));
  }
  EXPECT_EQ(next, near.size());
  EXPECT_LT(near.size(), samples.points.size());
  EXPECT_EQ(samples.within(100.0).size(), samples.points.size());
}

TEST(SampleMap, GivesUpOnAGaussianWithoutMassInItsCellAndCountsWhatIsMissing) {                 // sigma = 10,000 cells
  const GaussianMap<3> map = mapOf({{0, 0, 0}, {1, 0, 0}}, {{{0, 0, 0}, 1e8 * kIdentity, 1.0},  //
                                                            {{0, 0, 0}, 0.0001 * kIdentity, 1.0}});
  SampleOptions options;
  options.samples = 200;
  const MapSamples<3> samples = sampleMap(map, 0, options);
  EXPECT_EQ(samples.unplaced, 200u);
  EXPECT_EQ(samples.points.size(), 30u);
  EXPECT_EQ(samplesOf(samples, 0), 0u);
  EXPECT_EQ(samplesOf(samples, 1), 30u);
  for (const Vector<3>& point : samples.points) EXPECT_EQ(map.grid().keyOf(point, 0), (CellKey<3>{1, 0, 0}));
}

TEST(SampleMap, DoesNotChangeAGaussiansSamplesWhenACellComesBeforeIt) {
  const Gaussian<3> gaussian{{0, 0, 0}, 0.0016 * kIdentity, 1.0};
  SampleOptions options;
  options.samples = 0;  // the minimum of 30 for each, whatever else there is
  const MapSamples<3> alone = sampleMap(mapOf({{4, 0, 0}}, {gaussian}), 0, options);
  const MapSamples<3> second = sampleMap(mapOf({{1, 0, 0}, {4, 0, 0}}, {gaussian, gaussian}), 0, options);
  ASSERT_EQ(alone.points.size(), 30u);
  ASSERT_EQ(second.points.size(), 60u);
  EXPECT_TRUE(std::equal(alone.points.begin(), alone.points.end(), second.points.begin() + 30));
  EXPECT_NE(second.points[0] + Vector<3>(3, 0, 0), second.points[30]);  // and cells do not repeat each other
}

TEST(SampleMap, DrawsDifferentSamplesForGaussiansOfOneCell) {
  MapScale<3> scale;
  scale.keys = {{0, 0, 0}};
  scale.first_gaussian = {0, 2};
  scale.gaussians.assign(2, {{0, 0, 0}, 0.0016 * kIdentity, 1.0});
  SampleOptions options;
  options.samples = 60;
  const MapSamples<3> samples = sampleMap(GaussianMap<3>(MapOptions{1.0, 10, 1, 0.01}, {scale}), 0, options);
  ASSERT_EQ(samples.points.size(), 60u);
  EXPECT_NE(samples.points[0], samples.points[30]);
}

TEST(SampleMap, OfAnEmptyMapIsEmptyAndOfAMissingScaleRefused) {
  EXPECT_TRUE(sampleMap(GaussianMap<3>(), 0).points.empty());
  EXPECT_THROW(sampleMap(GaussianMap<3>(), 3), std::out_of_range);
  EXPECT_THROW(sampleMap(GaussianMap<3>(), -1), std::out_of_range);
}

TEST(SampleMap, RefusesASingularCovariance) {
  Gaussian<3> flat{{0, 0, 0}, kIdentity, 1.0};
  flat.cov(2, 2) = 0.0;
  EXPECT_THROW(sampleMap(mapOf({{0, 0, 0}}, {flat}), 0), std::domain_error);
}

}  // namespace
}  // namespace gaussmap
