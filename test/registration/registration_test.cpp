// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/registration/registration.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "simulation/simulation.h"

namespace gaussmap {
namespace {

Pose posed(const Eigen::Vector3d& translation, double degrees, const Eigen::Vector3d& axis) {
  return {translation, Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::acos(-1.0) / 180.0, axis.normalized()))};
}

/// `then` after `first`.
Pose combined(const Pose& then, const Pose& first) {
  return {then.rotation * first.translation + then.translation,
          Eigen::Quaterniond(then.rotation) * Eigen::Quaterniond(first.rotation)};
}

double apart(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm();
}
double turned(const Pose& a, const Pose& b) {  // [degree]
  return Eigen::Quaterniond(a.rotation).angularDistance(Eigen::Quaterniond(b.rotation)) * 180.0 / std::acos(-1.0);
}

/// The first scans of the hall, noise 1 cm.
struct Hall {
  std::vector<SimulatedScan> scans;
  GaussianMapOctree map;  // of the first

  explicit Hall(std::size_t count) {
    Simulation hall = makeSimulation(WorldName::Hall);
    std::get<LidarOptions>(hall.sensor).columns = 450;
    for (std::size_t i = 0; i < count; ++i) scans.push_back(simulateScan(hall, i));
    map = refine<3>(build<3>(inMap(0), {0.2, 3, 4, 0.0})).map;
  }
  std::vector<Vector<3>> inMap(std::size_t i) const {
    std::vector<Vector<3>> points;
    for (const Eigen::Vector3d& point : scans[i].points)
      points.push_back(scans[i].pose.rotation * point + scans[i].pose.translation);
    return points;
  }
};

/// A corridor along x, 2 m wide and high and 12 m long; `end` = with a wall across it.
std::vector<Vector<3>> corridor(bool end, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vector<3>> points;
  for (int i = 0; i < 30000; ++i) {
    const double x = 12.0 * random.uniform() - 6.0, across = 2.0 * random.uniform() - 1.0,
                 noise = 0.01 * random.normal();
    const int side = i % 4;
    points.push_back(side == 0   ? Vector<3>(x, 1.03 + noise, across)
                     : side == 1 ? Vector<3>(x, -0.97 + noise, across)
                     : side == 2 ? Vector<3>(x, across, -1.03 + noise)
                                 : Vector<3>(x, across, 0.97 + noise));
    if (end && i % 5 == 0) points.emplace_back(3.07 + noise, across, 2.0 * random.uniform() - 1.0);
  }
  return points;
}

TEST(Registration, FindsThePoseOfTheScanThatTheMapIsMadeOf) {
  const Hall hall(1);
  const Pose truth = hall.scans[0].pose;
  const RegistrationResult result =
      registerScan(hall.scans[0].points, hall.map, combined(posed({0.5, -0.4, 0.2}, 4.0, {1, 1, 4}), truth));
  EXPECT_TRUE(result.converged);
  EXPECT_FALSE(result.degenerate);
  EXPECT_LT(apart(result.pose, truth), 0.003);
  EXPECT_LT(turned(result.pose, truth), 0.03);
  EXPECT_GT(result.fitness, 0.95);
}

TEST(Registration, FindsTheNextScanFromFarAway) {
  const Hall hall(3);
  Random random(3);
  for (std::size_t i = 1; i < 3; ++i) {
    const Pose truth = hall.scans[i].pose;
    for (int k = 0; k < 4; ++k) {
      Pose guess = truth;
      guess.translation += 2.0 * Eigen::Vector3d(random.normal(), random.normal(), 0.1).normalized();
      guess.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(random.uniform() - 0.5, Eigen::Vector3d::UnitZ())) *
                       Eigen::Quaterniond(truth.rotation);
      const RegistrationResult result = registerScan(hall.scans[i].points, hall.map, guess);
      EXPECT_LT(apart(result.pose, truth), 0.02) << i << ' ' << k;
      EXPECT_LT(turned(result.pose, truth), 0.2) << i << ' ' << k;
    }
  }
}

TEST(Registration, MovesOneMapOntoAnother) {
  const Hall hall(2);
  const Pose offset = posed({0.7, -0.5, 0.1}, 6.0, {0, 0.1, 1});
  std::vector<Vector<3>> elsewhere;
  for (const Vector<3>& point : hall.inMap(1))
    elsewhere.push_back(offset.rotation.conjugate() * (point - offset.translation));
  const GaussianMapOctree other = build<3>(elsewhere, {0.2, 3, 3, 0.0});
  for (const GaussianMapOctree& source : {other, refine<3>(other).map, finish<3>(other)}) {
    const RegistrationResult result = registerMap(source, hall.map);
    EXPECT_TRUE(result.converged);
    EXPECT_FALSE(result.degenerate);
    EXPECT_GT(result.fitness, 0.5);
    EXPECT_LT(apart(result.pose, offset), 0.03);
    EXPECT_LT(turned(result.pose, offset), 0.2);
  }
}

TEST(Registration, OfAMapIsThatOfTheScanThatItIsMadeOf) {
  const Hall hall(2);
  const GaussianMapOctree source = build<3>(hall.scans[1].points, {0.2, 4, 2, 0.0});
  const RegistrationResult by_map = registerMap(source, hall.map, hall.scans[0].pose);
  const RegistrationResult by_scan = registerScan(hall.scans[1].points, hall.map, hall.scans[0].pose);
  EXPECT_EQ(by_map.pose.translation, by_scan.pose.translation);
  EXPECT_EQ(by_map.covariance, by_scan.covariance);
}

TEST(Registration, OfAMapOfAnotherResolutionTakesTheScaleThatFits) {
  const Hall hall(2);
  const GaussianMapOctree source = build<3>(hall.scans[1].points, {0.05, 2, 6, 0.0});
  const RegistrationResult result = registerMap(source, hall.map, hall.scans[0].pose);
  EXPECT_LT(apart(result.pose, hall.scans[1].pose), 0.02);
  EXPECT_GT(result.fitness, 0.5);
}

TEST(Registration, StaysWithTheGuessWhenTheOtherMapIsEmpty) {
  const Hall hall(1);
  const Pose guess = posed({1, 2, 3}, 10.0, {0, 0, 1});
  const RegistrationResult result = registerMap(GaussianMapOctree(), hall.map, guess);
  EXPECT_LT(apart(result.pose, guess), 1e-12);
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(result.degenerate);
}

TEST(Registration, SaysThatACorridorDoesNotTellWhereAlongIt) {
  const GaussianMapOctree open = refine<3>(build<3>(corridor(false, 1), {0.25, 4, 2, 0.0})).map;
  const std::vector<Vector<3>> scan = corridor(false, 2);
  const RegistrationResult lost = registerScan({scan.begin(), scan.end()}, open);
  EXPECT_TRUE(lost.degenerate);
  EXPECT_GT(std::abs(lost.least_observable[0]), 0.99);
  EXPECT_NEAR(lost.pose.translation.y(), 0.0, 0.01);
  EXPECT_NEAR(lost.pose.translation.z(), 0.0, 0.01);

  const GaussianMapOctree closed = refine<3>(build<3>(corridor(true, 1), {0.25, 4, 2, 0.0})).map;
  const std::vector<Vector<3>> seen = corridor(true, 2);
  const RegistrationResult found = registerScan({seen.begin(), seen.end()}, closed, posed({0.2, 0, 0}, 0.0, {0, 0, 1}));
  EXPECT_FALSE(found.degenerate);
  EXPECT_NEAR(found.pose.translation.x(), 0.0, 0.02);
  EXPECT_LT(found.covariance(0, 0), lost.covariance(0, 0));
}

TEST(Registration, GivesACovarianceThatIsSymmetricPositiveDefinite) {
  const Hall hall(2);
  const RegistrationResult result = registerScan(hall.scans[1].points, hall.map, hall.scans[1].pose);
  EXPECT_EQ(result.covariance, result.covariance.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(result.covariance);
  EXPECT_GT(solver.eigenvalues()[0], 0.0);
  EXPECT_LT(result.covariance(0, 0), 0.01 * 0.01);
}

TEST(Registration, LosesNothingFarFromTheOrigin) {
  const Hall hall(2);
  const Eigen::Vector3d far(1e7, -2e7, 5e6);
  std::vector<Vector<3>> points = hall.inMap(0);
  for (Vector<3>& point : points) point += far;
  const GaussianMapOctree there = refine<3>(build<3>(points, {0.2, 3, 4, 0.0})).map;
  const Pose truth = hall.scans[1].pose;
  Pose guess = truth;
  guess.translation += far + Eigen::Vector3d(0.4, 0.3, 0.0);
  const RegistrationResult result = registerScan(hall.scans[1].points, there, guess);
  EXPECT_LT((result.pose.translation - far - truth.translation).norm(), 0.02);
}

TEST(Registration, DependsNeitherOnThreadsNorOnTheOrderOfPoints) {
  const Hall hall(2);
  RegistrationOptions two;
  two.threads = 2;
  std::vector<Eigen::Vector3d> reversed(hall.scans[1].points.rbegin(), hall.scans[1].points.rend());
  const RegistrationResult a = registerScan(hall.scans[1].points, hall.map, hall.scans[0].pose);
  const RegistrationResult b = registerScan(reversed, hall.map, hall.scans[0].pose, two);
  EXPECT_EQ(a.pose.translation, b.pose.translation);
  EXPECT_EQ(a.pose.rotation.coeffs(), b.pose.rotation.coeffs());
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.iterations, b.iterations);
}

TEST(Registration, StaysWithTheGuessWhenTheScanHoldsNothing) {
  const Hall hall(1);
  const Pose guess = posed({1, 2, 3}, 10.0, {0, 0, 1});
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const std::vector<Eigen::Vector3d>& points :
       {std::vector<Eigen::Vector3d>{}, {{nan, 0, 0}, {0, inf, 0}}, {{5000, 5000, 5000}}}) {
    const RegistrationResult result = registerScan(points, hall.map, guess);
    EXPECT_LT(apart(result.pose, guess), 1e-12);
    EXPECT_EQ(result.fitness, 0.0);
    EXPECT_TRUE(result.degenerate);
    EXPECT_TRUE(result.covariance.isZero());
  }
}

TEST(Registration, TakesOnePointForDegenerate) {
  const Hall hall(1);
  const RegistrationResult result = registerScan({hall.scans[0].points[5]}, hall.map, hall.scans[0].pose);
  EXPECT_TRUE(result.degenerate);
  EXPECT_TRUE(result.pose.translation.allFinite());
  EXPECT_TRUE(result.covariance.allFinite());
}

TEST(Registration, RefusesWhatMeansNothing) {
  const Hall hall(1);
  const auto refused = [&](auto change) {
    RegistrationOptions options;
    change(options);
    EXPECT_THROW(registerScan(hall.scans[0].points, hall.map, {}, options), std::invalid_argument);
  };
  refused([](auto& o) { o.resolution = -1.0; });
  refused([](auto& o) { o.resolution = std::numeric_limits<double>::infinity(); });
  refused([](auto& o) { o.max_gaussians = 0; });
  refused([](auto& o) { o.max_iterations = 0; });
  refused([](auto& o) { o.kernel = 0.0; });
  refused([](auto& o) { o.translation = 0.0; });
  refused([](auto& o) { o.rotation = std::numeric_limits<double>::quiet_NaN(); });
  refused([](auto& o) { o.degenerate = -1.0; });
  refused([](auto& o) { o.threads = -1; });
  EXPECT_THROW(registerScan(hall.scans[0].points, GaussianMapOctree()), std::invalid_argument);
  Pose bad;
  bad.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(registerScan(hall.scans[0].points, hall.map, bad), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
