// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/evaluation/held_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap {
namespace {

constexpr double kNothing = -std::numeric_limits<double>::infinity();

template <int D>
std::vector<Vector<D>> randomPoints(std::size_t count, std::uint64_t seed, double side, double far = 0.0) {
  Random random(seed);
  std::vector<Vector<D>> points(count);
  for (Vector<D>& point : points)
    for (int axis = 0; axis < D; ++axis) point(axis) = far + side * random.uniform();
  return points;
}

/// One cell of 1 m around the origin's corner (0, 0, 0), with one Gaussian in its middle.
GaussianMap<3> oneGaussian(double sigma) {
  MapScale<3> scale;
  scale.keys = {{0, 0, 0}};
  scale.gaussians = {{{0, 0, 0}, sigma * sigma * Matrix<3>::Identity(), 50.0}};
  return GaussianMap<3>(MapOptions{1.0, 10, 1, 0.01}, {scale});
}

template <int D>
void expectTwin(double far) {
  // Half of the points in the map's part of space, half of them around it.
  const GaussianMap<D> map = build<D>(randomPoints<D>(3000, 1, 1.0, far), MapOptions{0.05, 3, 3, 0.003});
  const std::vector<Vector<D>> points = randomPoints<D>(2000, 2, 2.0, far - 0.5);
  for (int scale = 0; scale < map.scales(); ++scale) {
    const std::vector<double> batch = logLikelihoods<D>(map, scale, points);
    ASSERT_EQ(batch.size(), points.size());
    std::size_t nothing = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double single = logLikelihood<D>(map, points[i], scale);
      nothing += single == kNothing;
      if (single == kNothing)
        ASSERT_EQ(batch[i], kNothing) << "point " << i << " of scale " << scale;
      else
        ASSERT_NEAR(batch[i], single, 1e-9 * (1.0 + std::abs(single))) << "point " << i << " of scale " << scale;
    }
    EXPECT_GT(nothing, 0u);
    EXPECT_LT(nothing, points.size());
  }
}
TEST(LogLikelihoods, AreThoseOfSinglePointsIn2D) {
  expectTwin<2>(0.0);
}
TEST(LogLikelihoods, AreThoseOfSinglePointsIn3D) {
  expectTwin<3>(0.0);
}
TEST(LogLikelihoods, AreThoseOfSinglePointsTenThousandKilometresAway) {
  expectTwin<3>(-1e7);
}

TEST(LogLikelihoods, OfOneGaussianAreItsDensity) {  // -ln((2 pi)^1.5 sigma^3) at its mean
  const double sigma = 0.1, at_mean = -1.5 * std::log(2 * 3.14159265358979323846) - 3 * std::log(sigma);
  const std::vector<double> values =
      logLikelihoods<3>(oneGaussian(sigma), 0, {{0.5, 0.5, 0.5}, {0.7, 0.5, 0.5}, {1.5, 0.5, 0.5}, {2.5, 0.5, 0.5}});
  EXPECT_NEAR(values[0], at_mean, 1e-12);
  EXPECT_NEAR(values[1], at_mean - 2.0, 1e-12);   // 2 sigma
  EXPECT_NEAR(values[2], at_mean - 50.0, 1e-12);  // 10 sigma, in the next cell
  EXPECT_EQ(values[3], kNothing);                 // the cell after that
}

TEST(LogLikelihoods, DoNotDependOnThreadsNorOnTheOrderOfPoints) {
  const GaussianMap<3> map = build<3>(randomPoints<3>(20000, 3, 1.0), MapOptions{0.05, 4, 3, 0.003});
  std::vector<Vector<3>> points = randomPoints<3>(30000, 4, 1.2);
  for (int scale = 0; scale < 3; ++scale) {  // at the coarsest, a cell's points are more than one task's
    std::vector<double> one = logLikelihoods<3>(map, scale, points, 1);
    EXPECT_EQ(one, logLikelihoods<3>(map, scale, points, 2));
    EXPECT_EQ(one, logLikelihoods<3>(map, scale, points, 0));
    std::reverse(points.begin(), points.end());
    std::reverse(one.begin(), one.end());
    EXPECT_EQ(one, logLikelihoods<3>(map, scale, points));
  }
}

TEST(LogLikelihoods, OfNoPointsAreNoneAndOfAnEmptyMapNothing) {
  EXPECT_TRUE(logLikelihoods<3>(oneGaussian(0.1), 0, {}).empty());
  EXPECT_EQ(logLikelihoods<3>(GaussianMap<3>(), 0, {{1, 2, 3}}), std::vector<double>{kNothing});
}

TEST(LogLikelihoods, RefuseScalesAndPointsThatAreNotThere) {
  const GaussianMap<3> map = oneGaussian(0.1);
  EXPECT_THROW(logLikelihoods<3>(map, 1, {{0, 0, 0}}), std::out_of_range);
  EXPECT_THROW(logLikelihoods<3>(map, -1, {{0, 0, 0}}), std::out_of_range);
  EXPECT_THROW(logLikelihoods<3>(map, 0, {{0, 0, 0}, {1e300, 0, 0}}), std::out_of_range);
  EXPECT_THROW(logLikelihoods<3>(map, 0, {{0, 0, std::nan("")}}), std::out_of_range);
}

TEST(LogLikelihoods, RefuseASingularCovariance) {
  MapScale<3> scale;
  scale.keys = {{0, 0, 0}};
  scale.gaussians = {{{0, 0, 0}, Matrix<3>::Identity(), 1.0}};
  scale.gaussians[0].cov(2, 2) = 0.0;
  EXPECT_THROW(logLikelihoods<3>(GaussianMap<3>(MapOptions{1.0, 10, 1, 0.01}, {scale}), 0, {{0.5, 0.5, 0.5}}),
               std::domain_error);
}

TEST(HeldOut, MixesTheMapWithAUniformBackground) {
  // The box of these points is 4 m x 1 m x 1 m, since no side counts less than a metre.
  const std::vector<Vector<3>> points = {{0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {4.5, 0.5, 0.5}};
  const GaussianMap<3> map = oneGaussian(0.1);
  HeldOutOptions options;
  options.background = 0.2;
  const HeldOutResult result = heldOutLogLikelihood<3>(map, 0, points, options);
  EXPECT_DOUBLE_EQ(result.volume, 4.0);
  EXPECT_DOUBLE_EQ(result.floor, std::log(0.2 / 4.0));
  const auto expected = [&](std::size_t i) {
    return std::log(0.8 * std::exp(logLikelihood<3>(map, points[i], 0)) + 0.2 / 4.0);
  };
  EXPECT_NEAR(result.mean, (expected(0) + expected(1) + result.floor) / 3.0, 1e-12);
  EXPECT_NEAR(result.median, expected(1), 1e-12);
  EXPECT_EQ(result.count, 3u);
  EXPECT_EQ(result.in_no_cell, 2u);
  EXPECT_EQ(result.nowhere, 1u);
}

TEST(HeldOut, CountsEveryPointOfAnEmptyCell) {
  const std::vector<Vector<3>> points = {{0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {1.6, 0.5, 0.5}, {4.5, 0.5, 0.5},
                                         {4.6, 0.5, 0.5}, {4.7, 0.5, 0.5}, {0.6, 0.5, 0.5}};
  const HeldOutResult result = heldOutLogLikelihood<3>(oneGaussian(0.1), 0, points);
  EXPECT_EQ(result.in_no_cell, 5u);
  EXPECT_EQ(result.nowhere, 3u);
}

TEST(HeldOut, TakesTheVolumeThatIsGiven) {
  HeldOutOptions options;
  options.volume = 1000.0;
  const HeldOutResult result = heldOutLogLikelihood<3>(oneGaussian(0.1), 0, {{50, 50, 50}}, options);
  EXPECT_DOUBLE_EQ(result.floor, std::log(options.background / 1000.0));
  EXPECT_EQ(result.mean, result.floor);
  EXPECT_EQ(result.median, result.floor);
  EXPECT_EQ(result.nowhere, 1u);
}

TEST(HeldOut, IsNotRuinedByOnePointFarFromAllGaussians) {  // in the map's cell, but 400 sigma from its mean
  std::vector<Vector<3>> points(999, Vector<3>(0.5, 0.5, 0.5));
  const GaussianMap<3> map = oneGaussian(0.001);
  HeldOutOptions options;
  options.volume = 10.0;
  const double before = heldOutLogLikelihood<3>(map, 0, points, options).mean;
  points.emplace_back(0.9, 0.5, 0.5);
  EXPECT_EQ(logLikelihood<3>(map, points.back(), 0) < -70000.0, true);
  const HeldOutResult after = heldOutLogLikelihood<3>(map, 0, points, options);
  EXPECT_NEAR(after.mean, (999 * before + after.floor) / 1000, 1e-9);
}

TEST(HeldOut, IsTheEntropyOfAWallAndPrefersItsOwnPlace) {
  const auto wall = [](std::uint64_t seed) {
    std::vector<Vector<3>> points = randomPoints<3>(20000, seed, 4.0);
    for (Vector<3>& point : points) point.z() *= 0.005;
    return points;
  };
  const MapOptions options{0.2, 5, 2, 0.005};
  const GaussianMap<3> map = build<3>(wall(5), options);
  std::vector<Vector<3>> moved = wall(5);
  for (Vector<3>& point : moved) point.z() += 0.1;
  const double fine = heldOutLogLikelihood<3>(map, 0, wall(6)).mean;
  EXPECT_GT(fine, heldOutLogLikelihood<3>(build<3>(moved, options), 0, wall(6)).mean + 1.0);
  // Uniform over 4 m x 4 m: -ln 16. Across: N(0, 5.8 mm^2 + 5 mm^2 of noise) for points uniform in 2 cm: 3.68.
  EXPECT_NEAR(fine, 3.68 - std::log(16.0), 0.2);
}

TEST(HeldOut, RefusesNoPointsAndOptionsThatMakeNoSense) {
  const GaussianMap<3> map = oneGaussian(0.1);
  EXPECT_THROW(heldOutLogLikelihood<3>(map, 0, {}), std::invalid_argument);
  EXPECT_THROW(heldOutLogLikelihood<3>(map, 2, {{0, 0, 0}}), std::out_of_range);
  for (const double background : {0.0, 1.0, -0.1, std::nan("")}) {
    HeldOutOptions options;
    options.background = background;
    EXPECT_THROW(heldOutLogLikelihood<3>(map, 0, {{0, 0, 0}}, options), std::invalid_argument) << background;
  }
  HeldOutOptions options;
  options.volume = -1.0;
  EXPECT_THROW(heldOutLogLikelihood<3>(map, 0, {{0, 0, 0}}, options), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
