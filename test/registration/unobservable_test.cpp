// SPDX-License-Identifier: BSD-3-Clause
// Registration with scenes that leave some direction of the pose open. Sensor frame: x ahead, z up, metres.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/pi.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/registration/registration.h"

namespace gaussmap {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kNoise = 0.01;
constexpr double kHeight = 1.5;  // of the sensor above the floor

Points floorOf(double side, int count, std::uint64_t seed) {
  Random random(seed);
  Points points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(side * (random.uniform() - 0.5), side * (random.uniform() - 0.5),
                        -kHeight + kNoise * random.normal());
  return points;
}

/// A floor with one wall at y = 3.03.
Points floorAndWall(double side, int count, std::uint64_t seed) {
  Points points = floorOf(side, count, seed);
  Random random(seed + 100);
  for (int i = 0; i < count / 2; ++i)
    points.emplace_back(side * (random.uniform() - 0.5), 3.03 + kNoise * random.normal(), 3.0 * random.uniform() - 1.5);
  return points;
}

/// What a lidar with 32 rings sees of a floor.
Points ringsOnFloor(std::uint64_t seed) {
  Random random(seed);
  Points points;
  for (int ring = 0; ring < 32; ++ring)
    for (int i = 0; i < 900; ++i) {
      const double down = 0.1 + 0.015 * ring, around = 2.0 * detail::kPi * i / 900;
      const double range = kHeight / std::sin(down) + kNoise * random.normal();
      points.push_back(range * Eigen::Vector3d(std::cos(down) * std::cos(around), std::cos(down) * std::sin(around),
                                               -std::sin(down)));
    }
  return points;
}

/// A corridor along x, 2 m wide and high, from -length / 2 to length / 2.
Points corridor(double length, int count, std::uint64_t seed) {
  Random random(seed);
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = length * (random.uniform() - 0.5), across = 2.0 * random.uniform() - 1.0,
                 at = (i % 2 == 0 ? 1.03 : -0.97) + kNoise * random.normal();
    points.push_back(i % 4 < 2 ? Eigen::Vector3d(x, at, across) : Eigen::Vector3d(x, across, at));
  }
  return points;
}

Points sphere(int count, std::uint64_t seed) {
  Random random(seed);
  Points points;
  for (int i = 0; i < count; ++i)
    points.push_back((3.0 + kNoise * random.normal()) *
                     Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized());
  return points;
}

/// A scan of a planar laser between two walls along x, 2 m apart. `ends`: with walls at x = -4 and x = 5.
Points planarScan(bool ends, std::uint64_t seed) {
  Random random(seed);
  Points points;
  for (int i = 0; i < 720; ++i) {
    const Eigen::Vector3d ray(std::cos(2.0 * detail::kPi * i / 720), std::sin(2.0 * detail::kPi * i / 720), 0.0);
    double range = 1.0 / std::max(1e-9, std::abs(ray.y()));
    if (ends) range = std::min(range, (ray.x() > 0.0 ? 5.0 : 4.0) / std::max(1e-9, std::abs(ray.x())));
    if (range < 20.0) points.push_back((range + kNoise * random.normal()) * ray);
  }
  return points;
}

Pose guessAt(const Eigen::Vector3d& translation, const Eigen::Vector3d& rotation) {
  return {translation, Pose::Rotation(Eigen::AngleAxisd(rotation.norm(), rotation.normalized()))};
}

/// Guesses that are off by 2 cm to 30 cm and up to 3 degrees.
std::vector<Pose> guesses() {
  return {guessAt({0.05, 0.03, 0.02}, {0.0, 0.0, 1e-3}), guessAt({-0.3, 0.2, 0.1}, {0.01, -0.005, 0.05})};
}

/// The maps that GaussianMapRegistration and the examples build, and one with two scales.
std::vector<GaussianMapOctree> mapsOf(const Points& points) {
  std::vector<GaussianMapOctree> maps;
  for (const MapOptions& options :
       {MapOptions{0.5, 3, 4, 0.0}, MapOptions{0.2, 3, 4, 0.0}, MapOptions{0.25, 4, 2, 0.0}})
    maps.push_back(refine<3>(build<3>(points, options), PerCell{3.0}).map);
  return maps;
}

/// Returns the rotation vector from a guess to the result.
Eigen::Vector3d turnOf(const RegistrationResult& result, const Pose& guess) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(result.pose.rotation) *
                               Eigen::Quaterniond(guess.rotation).conjugate());
  return turn.angle() * turn.axis();
}

/// Expects that the standard deviation is about the RMS range. That of the Gaussians is larger than that of the points,
/// which are denser near the sensor.
void expectNearRange(double variance, const Points& scan) {
  double squared = 0.0;
  for (const Eigen::Vector3d& point : scan) squared += point.squaredNorm() / double(scan.size());
  EXPECT_GT(variance, 0.8 * squared);
  EXPECT_LT(variance, 3.0 * squared);
}

void expectInvertible(const PoseCovariance& covariance) {
  const Eigen::Matrix<double, 6, 6> matrix = covariance;
  EXPECT_EQ(matrix, matrix.transpose());
  const Eigen::LLT<Eigen::Matrix<double, 6, 6>> cholesky(matrix);
  ASSERT_EQ(cholesky.info(), Eigen::Success);
  const Eigen::Matrix<double, 6, 6> information = cholesky.solve(Eigen::Matrix<double, 6, 6>::Identity());
  EXPECT_LT((information * matrix - Eigen::Matrix<double, 6, 6>::Identity()).cwiseAbs().maxCoeff(), 1e-6);
}

/// Registers a scan of a plane with each guess, and expects that only height, roll and pitch are found.
void expectKeptInPlane(const Points& scan, const GaussianMapOctree& map) {
  for (const Pose& guess : guesses()) {
    const RegistrationResult result = registerScan(scan, map, guess);
    EXPECT_TRUE(result.converged);
    EXPECT_TRUE(result.degenerate);
    const Eigen::Vector3d moved = result.pose.translation - guess.translation;
    EXPECT_NEAR(moved.x(), 0.0, 0.002);
    EXPECT_NEAR(moved.y(), 0.0, 0.002);
    EXPECT_NEAR(result.pose.translation.z(), 0.0, 0.005);
    EXPECT_NEAR(turnOf(result, guess).z(), 0.0, 1e-3);
    EXPECT_NEAR((result.pose.rotation * Eigen::Vector3d::UnitZ()).z(), 1.0, 1e-5);
    EXPECT_NEAR(result.least_observable.norm(), 1.0, 1e-9);
    EXPECT_LT(std::abs(result.least_observable[2]), 0.1);
    expectInvertible(result.covariance);
    for (const int axis : {0, 1}) expectNearRange(result.covariance(axis, axis), scan);
    EXPECT_NEAR(std::sqrt(result.covariance(5, 5)), 1.0, 0.1);
    EXPECT_LT(std::sqrt(result.covariance(2, 2)), 0.2);
  }
}

TEST(Unobservable, PlaneOnPlaneKeepsTheGuessInThePlane) {
  for (const GaussianMapOctree& map : mapsOf(floorOf(10.0, 20000, 1))) expectKeptInPlane(floorOf(10.0, 20000, 2), map);
}

TEST(Unobservable, APartOfAPlaneDoesNotMoveToItsBorders) {
  for (const GaussianMapOctree& map : mapsOf(floorOf(20.0, 60000, 1))) expectKeptInPlane(floorOf(8.0, 20000, 2), map);
}

TEST(Unobservable, TheRingsOfALidarOnAPlaneTellNothing) {
  for (const GaussianMapOctree& map : mapsOf(ringsOnFloor(1))) expectKeptInPlane(ringsOnFloor(2), map);
}

/// The pose is that of the scan, but keeps the guess along x.
void expectKeptAlongX(const RegistrationResult& result, const Pose& guess) {
  EXPECT_TRUE(result.degenerate);
  EXPECT_NEAR(result.pose.translation.x(), guess.translation.x(), 0.002);
  EXPECT_NEAR(result.pose.translation.y(), 0.0, 0.01);
  EXPECT_NEAR(result.pose.translation.z(), 0.0, 0.01);
  EXPECT_LT(Eigen::AngleAxisd(Eigen::Quaterniond(result.pose.rotation)).angle(), 0.003);
  EXPECT_GT(std::abs(result.least_observable[0]), 0.99);
  expectInvertible(result.covariance);
}

TEST(Unobservable, ACorridorKeepsTheGuessAlongItsAxis) {
  for (const GaussianMapOctree& map : mapsOf(corridor(24.0, 60000, 1)))
    for (const Pose& guess : guesses()) {
      const Points scan = corridor(10.0, 30000, 2);
      const RegistrationResult result = registerScan(scan, map, guess);
      expectKeptAlongX(result, guess);
      expectNearRange(result.covariance(0, 0), scan);
      EXPECT_LT(std::sqrt(result.covariance(1, 1)), 0.2);
    }
}

TEST(Unobservable, AFloorWithOneWallKeepsTheGuessAlongTheWall) {
  for (const GaussianMapOctree& map : mapsOf(floorAndWall(16.0, 40000, 1)))
    for (const Pose& guess : guesses()) {
      const RegistrationResult result = registerScan(floorAndWall(8.0, 20000, 2), map, guess);
      expectKeptAlongX(result, guess);
    }
}

TEST(Unobservable, ASphereKeepsTheRotationAndTellsThePosition) {
  for (const GaussianMapOctree& map : mapsOf(sphere(30000, 1))) {
    if (map.grid().side(0) > 0.3) continue;  // such a map has corners
    for (const Pose& guess : guesses()) {
      const RegistrationResult result = registerScan(sphere(30000, 2), map, guess);
      EXPECT_TRUE(result.degenerate);
      EXPECT_LT(result.pose.translation.norm(), 0.005);
      EXPECT_LT(turnOf(result, guess).norm(), 1e-3);
      expectInvertible(result.covariance);
      for (const int axis : {3, 4, 5}) EXPECT_NEAR(std::sqrt(result.covariance(axis, axis)), 1.0, 0.1);
    }
  }
}

TEST(Unobservable, APlanarLaserFindsItsPoseInARoom) {
  for (const GaussianMapOctree& map : mapsOf(planarScan(true, 1)))
    for (const Pose& guess : {guessAt({0.05, 0.03, 0.0}, {0, 0, 1e-3}), guessAt({-0.2, 0.2, 0.0}, {0, 0, 0.05})}) {
      const RegistrationResult result = registerScan(planarScan(true, 2), map, guess);
      EXPECT_FALSE(result.degenerate);
      EXPECT_LT(result.pose.translation.norm(), 0.02);
      EXPECT_LT(Eigen::AngleAxisd(Eigen::Quaterniond(result.pose.rotation)).angle(), 0.005);
    }
}

TEST(Unobservable, APlanarLaserInAHallwayKeepsTheGuessAlongIt) {
  for (const GaussianMapOctree& map : mapsOf(planarScan(false, 1)))
    for (const Pose& guess : {guessAt({0.05, 0.03, 0.0}, {0, 0, 1e-3}), guessAt({-0.2, 0.1, 0.0}, {0, 0, 0.02})}) {
      const RegistrationResult result = registerScan(planarScan(false, 2), map, guess);
      EXPECT_TRUE(result.degenerate);
      EXPECT_NEAR(result.pose.translation.x(), guess.translation.x(), 0.005);
      EXPECT_NEAR(result.pose.translation.y(), 0.0, 0.02);
      EXPECT_LT(Eigen::AngleAxisd(Eigen::Quaterniond(result.pose.rotation)).angle(), 0.01);
    }
}

TEST(Unobservable, MapsOntoMapsKeepTheGuessToo) {
  const GaussianMapOctree source = build<3>(floorOf(8.0, 20000, 2), {0.5, 4, 2, 0.0});
  for (const Pose& guess : guesses()) {
    const RegistrationResult result = registerMap(source, mapsOf(floorOf(20.0, 60000, 1))[0], guess);
    EXPECT_TRUE(result.degenerate);
    EXPECT_NEAR(result.pose.translation.x(), guess.translation.x(), 0.002);
    EXPECT_NEAR(result.pose.translation.y(), guess.translation.y(), 0.002);
    EXPECT_NEAR(result.pose.translation.z(), 0.0, 0.005);
  }
}

TEST(Unobservable, NoLimitMeansThatNoDirectionIsHeld) {
  RegistrationOptions options;
  options.degenerate = 0.0;
  const GaussianMapOctree open = mapsOf(corridor(24.0, 60000, 1))[0];
  const RegistrationResult zero = registerScan(corridor(10.0, 30000, 2), open, guesses()[0], options);
  EXPECT_TRUE(zero.degenerate);  // the sum of the normals along the corridor is below zero, not only small
  options.degenerate = 0.9;      // all but the best directions
  const RegistrationResult most = registerScan(corridor(10.0, 30000, 2), open, guesses()[0], options);
  EXPECT_TRUE(most.degenerate);
  EXPECT_GT(most.covariance(3, 3), zero.covariance(3, 3));
}

TEST(Unobservable, AMapOfAFewPointsGivesNoPose) {
  for (const Points& target : {Points{{1.0, 1.0, 1.0}}, Points{{1.0, 1.0, 1.0}, {1.1, 1.0, 1.0}},
                               Points{{1.0, 1.0, 1.0}, {4.0, 1.0, 1.0}}, Points(100, {1.0, 1.0, 1.0})})
    for (const GaussianMapOctree& map : mapsOf(target))
      for (const Pose& guess : guesses()) {
        const RegistrationResult result = registerScan(sphere(3000, 2), map, guess);
        EXPECT_FALSE(result.converged);
        EXPECT_TRUE(result.degenerate);
        EXPECT_EQ(result.pose.translation, guess.translation);
        EXPECT_LT(turnOf(result, guess).norm(), 1e-12);
        EXPECT_TRUE(result.covariance.isZero());
        EXPECT_TRUE(result.least_observable.isZero());
      }
}

TEST(Unobservable, AScanOfOnePointGivesNoPose) {
  const GaussianMapOctree map = mapsOf(floorAndWall(16.0, 40000, 1))[0];
  const RegistrationResult result = registerScan({{1.0, 1.0, -kHeight}}, map, guesses()[0]);
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(result.degenerate);
  EXPECT_EQ(result.pose.translation, guesses()[0].translation);
}

}  // namespace
}  // namespace gaussmap
