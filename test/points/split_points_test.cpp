// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/points/split_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "gaussmap/core/gaussian.h"
#include "points/nearest_distances.h"

namespace gaussmap {
using namespace detail;

namespace {

using Points = std::vector<Vector<3>>;

/// A floor of 10 m x 10 m and a ball of 0.5 m on it, as many points on either.
Points floorAndBall(std::size_t count) {
  Random random(5);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(10 * random.uniform(), 10 * random.uniform(), 0.0);
    Vector<3> direction(random.normal(), random.normal(), random.normal());
    points.push_back(Vector<3>(5, 5, 0.5) + 0.5 * direction.normalized());
  }
  return points;
}

Points means(const PointParts& parts) {
  Points all;
  for (const Gaussian<3>& gaussian : parts.gaussians) all.push_back(gaussian.mean);
  return all;
}

TEST(SplitPoints, PartsFourHeapsAsFourHeaps) {
  Points points;
  for (const double x : {0.0, 10.0})
    for (const double y : {0.0, 10.0})
      for (const double d : {-0.1, 0.0, 0.1}) points.emplace_back(x + d, y, 0);
  SplitPointsOptions options;
  options.max_parts = 4;
  const PointParts parts = splitPoints(points, options);
  ASSERT_EQ(parts.gaussians.size(), 4u);
  EXPECT_EQ(parts.labels, (std::vector<std::uint32_t>{0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3}));
  EXPECT_EQ(parts.samples, (std::vector<std::uint32_t>{1, 4, 7, 10}));
  EXPECT_NEAR(parts.gaussians[3].mean.x(), 10.0, 1e-12);
  EXPECT_NEAR(parts.gaussians[3].cov(0, 0), 0.02 / 3.0, 1e-12);
  EXPECT_EQ(parts.gaussians[3].weight, 3.0);
  EXPECT_NEAR(parts.error, 0.1, 1e-12);
}

TEST(SplitPoints, GivesEveryPointToOnePartAndMatchesItsMoments) {
  const Points points = floorAndBall(1500);
  for (const SplitRule rule : {SplitRule::Distance, SplitRule::Shape}) {
    SplitPointsOptions options;
    options.max_parts = 100;
    options.rule = rule;
    const PointParts parts = splitPoints(points, options);
    ASSERT_EQ(parts.labels.size(), points.size());
    ASSERT_LE(parts.gaussians.size(), 100u);
    ASSERT_GE(parts.gaussians.size(), 95u);
    ASSERT_EQ(parts.samples.size(), parts.gaussians.size());
    EXPECT_TRUE(std::is_sorted(parts.samples.begin(), parts.samples.end()));
    for (std::uint32_t part = 0; part < parts.gaussians.size(); ++part) {
      std::vector<Gaussian<3>> members;
      for (std::size_t i = 0; i < points.size(); ++i)
        if (parts.labels[i] == part) members.push_back({points[i], Matrix<3>::Zero(), 1.0});
      const Gaussian<3> twin = merge(members);
      EXPECT_LT((twin.mean - parts.gaussians[part].mean).norm(), 1e-9);
      EXPECT_LT((twin.cov - parts.gaussians[part].cov).norm(), 1e-9);
      EXPECT_EQ(twin.weight, parts.gaussians[part].weight);
      EXPECT_EQ(parts.labels[parts.samples[part]], part);
      for (const Gaussian<3>& member : members)
        EXPECT_LE((points[parts.samples[part]] - twin.mean).norm(), (member.mean - twin.mean).norm() + 1e-12);
    }
  }
}

TEST(SplitPoints, MovesPointsToTheNearestMean) {
  const Points points = floorAndBall(2000);
  SplitPointsOptions options;
  options.max_parts = 60;
  options.rounds = 200;  // until nothing moves
  const PointParts parts = splitPoints(points, options);
  const std::vector<double> nearest = nearestDistances(points, means(parts));
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR((points[i] - parts.gaussians[parts.labels[i]].mean).norm(), nearest[i], 1e-9);
}

TEST(SplitPoints, HoldTheErrorWithFewParts) {
  const Points points = floorAndBall(2000);
  for (const PartPoint part_point : {PartPoint::Mean, PartPoint::Sample})
    for (const double error : {0.2, 0.5, 2.0}) {
      SplitPointsOptions options;
      options.max_error = error;
      options.part_point = part_point;
      const PointParts parts = splitPoints(points, options);
      EXPECT_LE(parts.error, error);
      Points kept = means(parts);
      if (part_point == PartPoint::Sample)
        for (std::size_t k = 0; k < kept.size(); ++k) kept[k] = points[parts.samples[k]];
      std::vector<double> distances = nearestDistances(points, kept);
      std::sort(distances.begin(), distances.end());
      EXPECT_LE(distances[distances.size() * 95 / 100 - 1], error);
      options.max_error = 0.0;
      options.rounds = 0;
      options.max_parts = parts.gaussians.size() * 9 / 10;
      EXPECT_GT(splitPoints(points, options).error, error);  // a tenth fewer would not do
    }
}

TEST(SplitPoints, KeepsTheBudgetWhereTheErrorAsksForMore) {
  SplitPointsOptions options;
  options.max_error = 1e-6;
  options.max_parts = 50;
  const PointParts parts = splitPoints(floorAndBall(500), options);
  EXPECT_LE(parts.gaussians.size(), 50u);
  EXPECT_GT(parts.error, 1e-6);
}

TEST(SplitPoints, ByShapeSpendsPartsWhereTheSurfaceBends) {
  const Points points = floorAndBall(2000);
  const auto onFloor = [&](SplitRule rule) {
    SplitPointsOptions options;
    options.max_parts = 200;
    options.rule = rule;
    std::size_t floor = 0;
    for (const Gaussian<3>& gaussian : splitPoints(points, options).gaussians) floor += gaussian.mean.z() < 1e-6;
    return floor;
  };
  EXPECT_GT(onFloor(SplitRule::Distance), 120u);
  EXPECT_LT(onFloor(SplitRule::Shape), 60u);
}

TEST(SplitPoints, DoesNotDependOnThreads) {
  const Points points = floorAndBall(6000);
  SplitPointsOptions options;
  options.max_parts = 300;
  options.threads = 1;
  const PointParts one = splitPoints(points, options);
  options.threads = 2;
  const PointParts two = splitPoints(points, options);
  EXPECT_EQ(one.labels, two.labels);
  EXPECT_EQ(one.error, two.error);
}

TEST(SplitPoints, TakesNoneOneAndEqualPoints) {
  EXPECT_TRUE(splitPoints({}).gaussians.empty());
  const PointParts one = splitPoints({{1, 2, 3}});
  ASSERT_EQ(one.gaussians.size(), 1u);
  EXPECT_EQ(one.gaussians[0].mean, Vector<3>(1, 2, 3));
  EXPECT_EQ(one.error, 0.0);
  const PointParts equal = splitPoints(Points(100, Vector<3>(1, 2, 3)));
  EXPECT_EQ(equal.gaussians.size(), 1u);
  SplitPointsOptions options;
  options.max_error = 0.1;
  EXPECT_EQ(splitPoints(Points(100, Vector<3>(1, 2, 3)), options).gaussians.size(), 1u);
  options.rule = SplitRule::Shape;
  EXPECT_EQ(splitPoints(Points(100, Vector<3>(1, 2, 3)), options).gaussians.size(), 1u);
}

TEST(SplitPoints, PartsFarPointsAsNearOnes) {
  Points near, far;
  for (const Vector<3>& p : floorAndBall(300)) {
    near.push_back((p * 1024).array().round() / 1024);  // exact in both places
    far.push_back(near.back() + Vector<3>(1e7, -1e7, 1e7));
  }
  SplitPointsOptions options;
  options.max_parts = 40;
  options.rounds = 0;
  EXPECT_NEAR(splitPoints(far, options).error, splitPoints(near, options).error, 1e-6);
}

TEST(SplitPoints, NamesWhatItCannotTake) {
  EXPECT_THROW(splitPoints({{0, 0, std::numeric_limits<double>::quiet_NaN()}}), std::invalid_argument);
  SplitPointsOptions options;
  options.max_parts = 0;
  EXPECT_THROW(splitPoints({}, options), std::invalid_argument);
  options = {};
  options.max_error = -1;
  EXPECT_THROW(splitPoints({}, options), std::invalid_argument);
  options = {};
  options.rounds = -1;
  EXPECT_THROW(splitPoints({}, options), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
