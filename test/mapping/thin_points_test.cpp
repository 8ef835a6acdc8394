// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include "core/quantile.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/mapping/thin_points.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

using Cloud = std::vector<std::array<float, 3>>;

PointsView viewOf(const Cloud& cloud) {
  return {cloud.empty() ? nullptr : cloud[0].data(), cloud.size(), 3};
}

Vector<3> vectorOf(const std::array<float, 3>& p) {
  return {p[0], p[1], p[2]};
}

std::array<float, 3> pointAt(double x, double y, double z) {
  return {float(x), float(y), float(z)};
}

/// A floor of 20 m x 20 m, a wall and a ball, with noise of 1 cm. The density of the floor falls with the distance.
Cloud room(std::size_t count, std::uint64_t seed = 3) {
  Random random(seed);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = random.uniform(), v = random.uniform(), noise = 0.01 * random.normal();
    const double radius = 0.5 + 9.5 * u * u, angle = 6.2831853 * v;
    Vector<3> direction(random.normal(), random.normal(), random.normal());
    direction = Vector<3>(-3, 2, 1) + (0.8 + noise) * direction.normalized();
    if (i % 3 == 0) cloud.push_back(pointAt(radius * std::cos(angle), radius * std::sin(angle), noise));
    if (i % 3 == 1) cloud.push_back(pointAt(5 + 0.3 * u + noise, 12 * v - 6, 3 * u));
    if (i % 3 == 2) cloud.push_back(pointAt(direction.x(), direction.y(), direction.z()));
  }
  return cloud;
}

/// Random bumps over a slanted plane, evenly dense.
Cloud hills(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const double a = 2 * random.uniform(), b = 1 + 2 * random.uniform(), slant = random.uniform();
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = 10 * random.uniform(), y = 10 * random.uniform();
    cloud.push_back(pointAt(x, y, slant * x + a * std::sin(b * x) * std::cos(y) + 0.005 * random.normal()));
  }
  return cloud;
}

struct Distances {
  double q95 = 0.0, mean = 0.0;
};

/// The distances from the points to the nearest mean.
Distances distancesTo(const std::vector<Gaussian<3>>& gaussians, const Cloud& cloud) {
  std::vector<Vector<3>> points, means;
  for (const auto& p : cloud) points.push_back(vectorOf(p));
  for (const auto& gaussian : gaussians) means.push_back(gaussian.mean);
  std::vector<double> all = nearestDistances(points, means);
  const double mean = std::accumulate(all.begin(), all.end(), 0.0) / double(all.size());
  return {percentile(all, 95), mean};
}

TEST(ThinPoints, FindsFourHeapsWithTheirMomentsOnPaper) {
  Cloud cloud;
  for (const double x : {0.0, 10.0})
    for (const double y : {0.0, 10.0})
      for (const double d : {-0.125, 0.0, 0.125}) cloud.push_back(pointAt(x + d, y, 0));
  ThinPointsOptions options;
  options.max_gaussians = 4;
  const ThinnedPoints thinned = thinPoints(viewOf(cloud), options);
  ASSERT_EQ(thinned.gaussians.size(), 4u);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& gaussian = thinned.gaussians[std::size_t(thinned.labels[i])];
    const Vector<3> centre = vectorOf(cloud[i - i % 3 + 1]);
    EXPECT_EQ(thinned.labels[i], thinned.labels[i - i % 3]);
    EXPECT_LT((gaussian.mean - centre).norm(), 1e-6);
    EXPECT_NEAR(gaussian.cov(0, 0), 2 * 0.125 * 0.125 / 3, 1e-6);
    EXPECT_EQ(gaussian.weight, 3.0);
    EXPECT_EQ(thinned.samples[std::size_t(thinned.labels[i])], i - i % 3 + 1);
  }
  EXPECT_NEAR(thinned.error, 0.125, 1e-6);
}

TEST(ThinPoints, LabelsSamplesMomentsAndErrorAreThoseOfBruteForce) {
  Cloud cloud = room(4000);
  cloud[7][1] = std::numeric_limits<float>::quiet_NaN();
  cloud[8][2] = std::numeric_limits<float>::infinity();
  for (const PartPoint part_point : {PartPoint::Mean, PartPoint::Sample})
    for (const std::size_t budget : {1u, 30u, 700u}) {
      ThinPointsOptions options;
      options.max_gaussians = budget;
      options.part_point = part_point;
      const ThinnedPoints thinned = thinPoints(viewOf(cloud), options);
      ASSERT_LE(thinned.gaussians.size(), budget);
      EXPECT_GE(thinned.gaussians.size(), budget);  // the budget is used
      ASSERT_EQ(thinned.labels.size(), cloud.size());
      EXPECT_EQ(thinned.labels[7], -1);
      EXPECT_EQ(thinned.labels[8], -1);
      std::vector<double> all;
      for (std::size_t g = 0; g < thinned.gaussians.size(); ++g) {
        Vector<3> mean = Vector<3>::Zero();
        double count = 0.0, least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < cloud.size(); ++i)
          if (thinned.labels[i] == std::int32_t(g)) {
            mean += vectorOf(cloud[i]);
            count += 1.0;
          }
        mean /= count;
        Matrix<3> cov = Matrix<3>::Zero();
        std::size_t nearest = 0;
        for (std::size_t i = 0; i < cloud.size(); ++i)
          if (thinned.labels[i] == std::int32_t(g)) {
            const Vector<3> d = vectorOf(cloud[i]) - mean;
            cov += d * d.transpose() / count;
            if (d.norm() < least) nearest = i;
            least = std::min(least, d.norm());
          }
        EXPECT_EQ(thinned.gaussians[g].weight, count);
        EXPECT_LT((thinned.gaussians[g].mean - mean).norm(), 1e-5);
        EXPECT_LT((thinned.gaussians[g].cov - cov).norm(), 1e-4 * (1e-3 + cov.norm()));
        EXPECT_NEAR((vectorOf(cloud[thinned.samples[g]]) - mean).norm(), least, 1e-5) << nearest;
        for (std::size_t i = 0; i < cloud.size(); ++i)
          if (thinned.labels[i] == std::int32_t(g))
            all.push_back(
                (vectorOf(cloud[i]) - (part_point == PartPoint::Mean ? mean : vectorOf(cloud[thinned.samples[g]])))
                    .norm());
      }
      EXPECT_EQ(all.size(), cloud.size() - 2);
      EXPECT_NEAR(thinned.error, percentile(all, 95), 2e-5);
    }
}

TEST(ThinPoints, GivesTheSameGaussiansForAnyOrderOfThePoints) {
  const Cloud cloud = room(20000);
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random random(9);
  for (std::size_t i = order.size(); i-- > 1;)
    std::swap(order[i], order[std::size_t(random.uniform() * double(i + 1))]);
  Cloud shuffled;
  for (const std::size_t i : order) shuffled.push_back(cloud[i]);
  ThinPointsOptions options;
  options.max_gaussians = 1000;
  const ThinnedPoints one = thinPoints(viewOf(cloud), options), two = thinPoints(viewOf(shuffled), options);
  ASSERT_EQ(one.gaussians.size(), two.gaussians.size());
  for (std::size_t g = 0; g < one.gaussians.size(); ++g) {
    EXPECT_EQ(one.gaussians[g].mean, two.gaussians[g].mean);
    EXPECT_EQ(one.gaussians[g].cov, two.gaussians[g].cov);
  }
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(two.labels[i], one.labels[order[i]]);
  EXPECT_EQ(one.error, two.error);
}

TEST(ThinPoints, KeepsTheBudgetAndUsesIt) {
  const Cloud cloud = room(5000);
  for (const std::size_t budget : {1u, 2u, 3u, 5u, 8u, 64u, 65u, 500u, 2500u, 4900u}) {
    ThinPointsOptions options;
    options.max_gaussians = budget;
    EXPECT_EQ(thinPoints(viewOf(cloud), options).gaussians.size(), budget);
  }
  EXPECT_EQ(thinPoints(viewOf(cloud)).gaussians.size(), cloud.size());  // fewer than the default budget
}

TEST(ThinPoints, KeepsTheErrorWithFewGaussians) {
  const Cloud cloud = room(20000);
  for (const PartPoint part_point : {PartPoint::Mean, PartPoint::Sample})
    for (const double max_error : {0.02, 0.1, 0.5, 1.5}) {
      ThinPointsOptions options;
      options.max_error = max_error;
      options.part_point = part_point;
      const ThinnedPoints thinned = thinPoints(viewOf(cloud), options);
      EXPECT_LE(thinned.error, max_error);
      EXPECT_TRUE(thinned.error_kept);
      ThinPointsOptions fewer;
      fewer.part_point = part_point;
      fewer.max_gaussians = 3 * thinned.gaussians.size() / 4;
      EXPECT_GT(thinPoints(viewOf(cloud), fewer).error, max_error);
    }
}

TEST(ThinPoints, SaysWhenABudgetOrALeafSizeDoesNotKeepTheError) {
  const Cloud cloud = room(20000);
  ThinPointsOptions options;
  options.max_error = 0.1;
  options.max_gaussians = 100;
  const ThinnedPoints few = thinPoints(viewOf(cloud), options);
  EXPECT_EQ(few.gaussians.size(), 100u);
  EXPECT_FALSE(few.error_kept);
  EXPECT_GT(few.error, 0.1);
  options.max_gaussians.reset();
  options.leaf_size = 1.0;
  EXPECT_FALSE(thinPoints(viewOf(cloud), options).error_kept);
  options.leaf_size = 0.05;
  EXPECT_TRUE(thinPoints(viewOf(cloud), options).error_kept);
}

TEST(ThinPoints, OfALeafSizeGivesOneGaussianPerOccupiedCellOfTheScale) {
  const Cloud cloud = room(5000);
  for (const int scale : {0, 1, 3}) {
    ThinPointsOptions options;
    options.leaf_size = 0.25;
    options.scale = scale;
    const ThinnedPoints thinned = thinPoints(viewOf(cloud), options);
    const double side = 0.25 * std::pow(2.0, scale);
    std::map<std::array<int, 3>, std::pair<Vector<3>, double>> cells;
    for (const auto& p : cloud) {
      auto& [sum, count] =
          cells
              .try_emplace({int(std::floor(p[0] / side)), int(std::floor(p[1] / side)), int(std::floor(p[2] / side))},
                           Vector<3>::Zero(), 0.0)
              .first->second;
      sum += vectorOf(p);
      count += 1.0;
    }
    ASSERT_EQ(thinned.gaussians.size(), cells.size());
    for (const Gaussian<3>& gaussian : thinned.gaussians) {
      std::array<int, 3> key;
      for (std::size_t axis = 0; axis < 3; ++axis)
        key[axis] = int(std::floor(gaussian.mean[Eigen::Index(axis)] / side));
      ASSERT_EQ(cells.count(key), 1u);
      EXPECT_EQ(gaussian.weight, cells[key].second);
      EXPECT_LT((gaussian.mean - cells[key].first / cells[key].second).norm(), side / 65536);
    }
  }
}

TEST(ThinPoints, IsNearerToTheInputThanAGridWithAsManyPoints) {
  for (const std::uint64_t seed : {1u, 2u, 3u})
    for (const Cloud& cloud : {room(15000, seed), hills(15000, seed)})
      for (const double leaf : {0.15, 0.5, 2.0}) {
        ThinPointsOptions options;
        options.leaf_size = leaf;
        const ThinnedPoints grid = thinPoints(viewOf(cloud), options);
        options.leaf_size = 0.0;
        options.max_gaussians = grid.gaussians.size();
        const ThinnedPoints thinned = thinPoints(viewOf(cloud), options);
        ASSERT_LE(thinned.gaussians.size(), grid.gaussians.size());
        const Distances ours = distancesTo(thinned.gaussians, cloud), theirs = distancesTo(grid.gaussians, cloud);
        EXPECT_LT(ours.q95, theirs.q95) << "leaf " << leaf << " seed " << seed;
        EXPECT_LT(ours.mean, theirs.mean) << "leaf " << leaf << " seed " << seed;
      }
}

TEST(ThinPoints, MakesAMapWithTheExactMomentsAndTheGaussians) {
  const Cloud cloud = room(20000);
  ThinPointsOptions options;
  options.max_gaussians = 500;
  const ThinnedPoints thinned = thinPoints(viewOf(cloud), options);
  const GaussianMapOctree map = thinned.map();
  ASSERT_EQ(map.scales(), 2);
  const MomentGrid<3> grid = countPoints(thinned.cell_side, viewOf(cloud), 1);
  std::size_t equal = 0;
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
    const CellMoments<3>* moments = grid.find(map.scale(0).keys[cell]);
    equal += moments != nullptr && *moments == map.scale(0).moments[cell];
  }
  // A point within 2^-17 sides of a border can be rounded into the next cell there, but not here.
  EXPECT_GE(equal + 4, map.cellCount(0));
  EXPECT_EQ(map.weight(0), double(cloud.size()));
  EXPECT_EQ(map.weight(1), double(cloud.size()));
  EXPECT_GE(map.gaussianCount(1), thinned.gaussians.size());
  EXPECT_LE(map.gaussianCount(1), thinned.gaussians.size() + thinned.gaussians.size() / 4);
  EXPECT_TRUE(map.acceptsScans());

  Cloud moved = cloud;  // away from the borders at 0, no Gaussian is cut
  for (auto& p : moved)
    for (float& coordinate : p) coordinate += 20.0f;
  const ThinnedPoints other = thinPoints(viewOf(moved), options);
  const GaussianMapOctree whole = other.map();
  if (whole.cellCount(1) == 1) {
    ASSERT_EQ(whole.gaussianCount(1), other.gaussians.size());
  }
  std::vector<double> weights, expected;
  for (std::size_t i = 0; i < whole.gaussianCount(1); ++i) weights.push_back(whole.gaussian(i, 1).weight);
  for (const Gaussian<3>& gaussian : other.gaussians) expected.push_back(gaussian.weight);
  EXPECT_EQ(std::accumulate(weights.begin(), weights.end(), 0.0),
            std::accumulate(expected.begin(), expected.end(), 0.0));
}

TEST(ThinPoints, TakesEmptyEqualFarAndTinyClouds) {
  EXPECT_TRUE(thinPoints({}).gaussians.empty());
  EXPECT_TRUE(thinPoints({}).map().empty());
  const Cloud nothing(5, {std::numeric_limits<float>::quiet_NaN(), 0, 0});
  EXPECT_TRUE(thinPoints(viewOf(nothing)).gaussians.empty());
  EXPECT_EQ(thinPoints(viewOf(nothing)).labels, std::vector<std::int32_t>(5, -1));
  for (const float x : {0.0f, 1.0f, -3e7f, 1e-20f}) {
    const Cloud equal(50, {x, x, 0});
    const ThinnedPoints one = thinPoints(viewOf(equal));
    ASSERT_EQ(one.gaussians.size(), 1u);
    EXPECT_EQ(one.gaussians[0].mean.cast<float>(), Eigen::Vector3f(x, x, 0));
    EXPECT_EQ(one.gaussians[0].weight, 50.0);
  }
  Cloud far, near;
  for (int i = 0; i < 4000; ++i) {
    near.push_back(pointAt(i % 64, i / 64, 0));
    far.push_back(pointAt(1e6 + i % 64, 1e6 + i / 64, 1e6));
  }
  ThinPointsOptions options;
  options.max_gaussians = 200;
  EXPECT_EQ(thinPoints(viewOf(far), options).gaussians.size(), 200u);
  EXPECT_LT(thinPoints(viewOf(far), options).error, 1.2 * thinPoints(viewOf(near), options).error);
}

TEST(ThinPoints, NamesOptionsThatAreOutOfRange) {
  const Cloud cloud = room(100);
  ThinPointsOptions options;
  options.max_gaussians = 0;
  EXPECT_THROW(thinPoints(viewOf(cloud), options), std::invalid_argument);
  options = {};
  options.max_error = -1.0;
  EXPECT_THROW(thinPoints(viewOf(cloud), options), std::invalid_argument);
  options = {};
  options.scale = 1;  // of no leaf size
  EXPECT_THROW(thinPoints(viewOf(cloud), options), std::invalid_argument);
  options = {};
  options.leaf_size = 1e-7;
  EXPECT_THROW(thinPoints(viewOf(cloud), options), std::out_of_range);
}

}  // namespace
}  // namespace gaussmap
