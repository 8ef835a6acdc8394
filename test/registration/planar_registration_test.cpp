// SPDX-License-Identifier: BSD-3-Clause
// Registration of planar scans and planar maps: known poses in rooms and corridors.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/about_z.h"
#include "gaussmap/editing/transform_map.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "gaussmap/registration/registration.h"

namespace gaussmap {
namespace {

struct WallPiece {
  Vector<2> from, to;
};
using Walls = std::vector<WallPiece>;

/// A room of 8 x 6 m with a column and a niche.
Walls roomWalls() {
  const std::vector<Vector<2>> outline = {{0, 0}, {8, 0}, {8, 6}, {5, 6}, {5, 7}, {3.5, 7}, {3.5, 6}, {0, 6}};
  const std::vector<Vector<2>> column = {{5.5, 2.5}, {6.3, 2.5}, {6.3, 3.1}, {5.5, 3.1}};
  Walls walls;
  for (const auto* ring : {&outline, &column})
    for (std::size_t i = 0; i < ring->size(); ++i) walls.push_back({(*ring)[i], (*ring)[(i + 1) % ring->size()]});
  return walls;
}

/// Two walls along x, 2 m apart, longer than the sensor sees.
Walls corridorWalls() {
  return {{{-60, -1}, {60, -1}}, {{-60, 1}, {60, 1}}};
}

Pose planarPose(double x, double y, double heading) {
  return {{x, y, 0.0}, detail::aboutZ(heading)};
}

double headingOf(const Pose& pose) {
  return 2.0 * std::atan2(pose.rotation.z(), pose.rotation.w());
}

double rangeTo(const Walls& walls, const Vector<2>& origin, double angle) {
  const Vector<2> ray(std::cos(angle), std::sin(angle));
  double nearest = std::numeric_limits<double>::infinity();
  for (const WallPiece& wall : walls) {
    const Vector<2> along = wall.to - wall.from, offset = wall.from - origin;
    const double cross = ray.x() * along.y() - ray.y() * along.x();
    if (std::abs(cross) < 1e-12) continue;
    const double range = (offset.x() * along.y() - offset.y() * along.x()) / cross,
                 place = (offset.x() * ray.y() - offset.y() * ray.x()) / cross;
    if (range > 0.0 && place >= 0.0 && place <= 1.0) nearest = std::min(nearest, range);
  }
  return nearest;
}

/// A scan of 720 beams with a noise of 1 cm, in the frame of the sensor.
std::vector<Eigen::Vector3d> scanOf(const Walls& walls, const Pose& pose, std::uint64_t seed, double reach = 30.0) {
  Random random(seed);
  std::vector<Eigen::Vector3d> points;
  for (int beam = 0; beam < 720; ++beam) {
    const double bearing = beam * M_PI / 360.0;
    const double range = rangeTo(walls, pose.translation.head<2>(), headingOf(pose) + bearing);
    if (range > reach) continue;
    const double measured = range + 0.01 * random.normal();
    points.emplace_back(measured * std::cos(bearing), measured * std::sin(bearing), 0.0);
  }
  return points;
}

GaussianMap<2> mapOf(const Walls& walls, const std::vector<Pose>& poses, double reach = 30.0,
                     const Vector<2>& shift = Vector<2>::Zero()) {
  std::vector<Vector<2>> points;
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (const Eigen::Vector3d& point : scanOf(walls, poses[i], 100 + i, reach))
      points.push_back(Vector<2>((poses[i] * point).head<2>()) + shift);
  return refine<2>(build<2>(points, {0.05, 10, 3, 0.0})).map;
}

std::vector<Pose> posesInRoom() {
  std::vector<Pose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back(planarPose(1.0 + 0.4 * i, 1.0 + 0.45 * i, 0.7 * i));
  return poses;
}

void expectPlanar(const RegistrationResult& result) {
  EXPECT_EQ(result.pose.translation.z(), 0.0);
  EXPECT_EQ(result.pose.rotation.x(), 0.0);
  EXPECT_EQ(result.pose.rotation.y(), 0.0);
  for (const int axis : {2, 3, 4}) {
    EXPECT_EQ(result.covariance.row(axis).norm(), 0.0);
    EXPECT_EQ(result.covariance.col(axis).norm(), 0.0);
    EXPECT_EQ(result.least_observable[axis], 0.0);
  }
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(result.covariance).eigenvalues().minCoeff(), 0.0);
}

double distanceBetween(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm();
}
double turnBetween(const Pose& a, const Pose& b) {
  return std::abs(std::remainder(headingOf(a) - headingOf(b), 2.0 * M_PI));
}

TEST(PlanarRegistration, FindsKnownPosesFromRandomGuesses) {
  const GaussianMap<2> map = mapOf(roomWalls(), posesInRoom());
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    const Pose truth = planarPose(1.0 + 3.5 * random.uniform(), 1.0 + 4.0 * random.uniform(), 6.0 * random.uniform());
    const Pose guess = planarPose(truth.translation.x() + 0.6 * (random.uniform() - 0.5),
                                  truth.translation.y() + 0.6 * (random.uniform() - 0.5),
                                  headingOf(truth) + 0.3 * (random.uniform() - 0.5));
    const RegistrationResult result = registerScan(scanOf(roomWalls(), truth, 7 + i), map, guess);
    expectPlanar(result);
    EXPECT_LT(distanceBetween(result.pose, truth), 0.005) << i;
    EXPECT_LT(turnBetween(result.pose, truth), 0.002) << i;
    EXPECT_TRUE(result.converged);
    EXPECT_FALSE(result.degenerate);
    EXPECT_GT(result.fitness, 0.9);
    const double deviation = std::sqrt(result.covariance(0, 0));
    EXPECT_GT(deviation, 1e-5);
    EXPECT_LT(deviation, 0.01);
  }
}

TEST(PlanarRegistration, AlongACorridorKeepsTheGuess) {
  std::vector<Pose> poses;
  for (int i = 0; i < 30; ++i) poses.push_back(planarPose(-6.0 + 0.4 * i, 0.2 * std::sin(i), 0.1 * i));
  const GaussianMap<2> map = mapOf(corridorWalls(), poses, 8.0);
  const Pose truth = planarPose(0.3, 0.1, 0.4);
  for (const double slip : {-0.3, 0.0, 0.25}) {
    const Pose guess = planarPose(truth.translation.x() + slip, 0.25, 0.45);
    const RegistrationResult result = registerScan(scanOf(corridorWalls(), truth, 3, 8.0), map, guess);
    expectPlanar(result);
    EXPECT_TRUE(result.degenerate);
    EXPECT_GT(std::abs(result.least_observable[0]), 0.99);
    EXPECT_NEAR(result.pose.translation.x(), guess.translation.x(), 0.01);
    EXPECT_NEAR(result.pose.translation.y(), 0.1, 0.01);
    EXPECT_LT(turnBetween(result.pose, truth), 0.005);
    EXPECT_GT(result.covariance(0, 0), 1.0);  // the RMS range of the scan, squared
    EXPECT_LT(result.covariance(1, 1), 1e-3);
  }
}

TEST(PlanarRegistration, AgreesWithASearchOverAGrid) {  // the pose with the smallest mean distance from the walls
  const Walls walls = roomWalls();
  const GaussianMap<2> map = mapOf(walls, posesInRoom());
  const Pose truth = planarPose(2.52, 3.04, 0.31);
  const std::vector<Eigen::Vector3d> scan = scanOf(walls, truth, 17);
  const auto cost = [&](const Pose& pose) {
    double sum = 0.0;
    for (std::size_t i = 0; i < scan.size(); i += 4) {
      const Vector<2> point = (pose * scan[i]).head<2>();
      double nearest = std::numeric_limits<double>::infinity();
      for (const WallPiece& wall : walls) {
        const Vector<2> along = wall.to - wall.from;
        const double place = std::clamp((point - wall.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (wall.from + place * along - point).squaredNorm());
      }
      sum += nearest;
    }
    return sum;
  };
  Pose best = truth;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j)
      for (int k = -8; k <= 8; ++k) {
        const Pose pose = planarPose(2.5 + 0.01 * i, 3.0 + 0.01 * j, 0.3 + 0.005 * k);
        if (cost(pose) >= least) continue;
        least = cost(pose);
        best = pose;
      }
  const Pose found = registerScan(scan, map, planarPose(2.6, 2.9, 0.35)).pose;
  EXPECT_LT((found.translation - best.translation).cwiseAbs().maxCoeff(), 0.01);
  EXPECT_LT(turnBetween(found, best), 0.005);
}

TEST(PlanarRegistration, AgreesWithRegistrationInSpaceOfTheExtrudedRoom) {
  const Walls walls = roomWalls();
  std::vector<Vector<3>> extruded;
  for (std::size_t i = 0; i < posesInRoom().size(); ++i)
    for (const Eigen::Vector3d& point : scanOf(walls, posesInRoom()[i], 100 + i))
      for (int level = 0; level < 12; ++level)
        extruded.push_back(posesInRoom()[i] * point + Eigen::Vector3d(0, 0, 0.1 * level - 0.55));
  for (int i = 0; i < 160; ++i)  // the floor, so that z, roll and pitch are observable
    for (int j = 0; j < 120; ++j) extruded.emplace_back(0.05 * i, 0.05 * j, -0.6);
  const GaussianMap<3> space = refine<3>(build<3>(extruded, {0.1, 10, 2, 0.0})).map;
  const GaussianMap<2> plane = mapOf(walls, posesInRoom());
  const Pose truth = planarPose(2.5, 3.1, 1.3), guess = planarPose(2.6, 3.0, 1.25);
  const std::vector<Eigen::Vector3d> scan = scanOf(walls, truth, 23);
  std::vector<Eigen::Vector3d> scan_in_space;
  for (const Eigen::Vector3d& point : scan)
    for (int level = 0; level < 12; ++level) scan_in_space.push_back(point + Eigen::Vector3d(0, 0, 0.1 * level - 0.55));
  for (int i = -30; i < 30; ++i)
    for (int j = -30; j < 30; ++j) scan_in_space.emplace_back(0.05 * i, 0.05 * j, -0.6);
  const RegistrationResult flat = registerScan(scan, plane, guess), whole = registerScan(scan_in_space, space, guess);
  EXPECT_LT(distanceBetween(whole.pose, truth), 0.01);
  EXPECT_LT((flat.pose.translation - whole.pose.translation).head<2>().norm(), 0.01);
  EXPECT_LT(turnBetween(flat.pose, whole.pose), 0.003);
}

TEST(PlanarRegistration, KeepsTheHeightAndTheTiltOfTheGuess) {
  const GaussianMap<2> map = mapOf(roomWalls(), posesInRoom());
  Pose truth = planarPose(3.0, 2.0, 0.8), guess = planarPose(3.1, 1.9, 0.85);
  const std::vector<Eigen::Vector3d> level = scanOf(roomWalls(), truth, 31);
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.6, 0.8, 0.0)));
  std::vector<Eigen::Vector3d> points;  // the walls at several heights, seen by a tilted sensor
  for (std::size_t i = 0; i < level.size(); ++i)
    points.push_back(tilt.inverse() * (level[i] + Eigen::Vector3d(0, 0, 0.1 * double(i % 7) - 0.3)));
  points.emplace_back(std::nan(""), 1, 1);
  points.emplace_back(1, 1, std::nan(""));
  guess.translation.z() = 1.7;
  guess.rotation = Eigen::Quaterniond(guess.rotation) * tilt;
  const RegistrationResult result = registerScan(points, map, guess);
  EXPECT_EQ(result.pose.translation.z(), 1.7);
  EXPECT_LT((result.pose.translation - truth.translation).head<2>().norm(), 0.005);
  const Eigen::Quaterniond turn(result.pose.rotation *
                                Pose::Rotation(Eigen::Quaterniond(truth.rotation) * tilt).conjugate());
  EXPECT_LT(turn.angularDistance(Eigen::Quaterniond::Identity()), 0.002);
  const Eigen::Quaterniond moved(result.pose.rotation * guess.rotation.conjugate());
  EXPECT_NEAR(moved.x(), 0.0, 1e-15);  // the result differs from the guess by a rotation about z
  EXPECT_NEAR(moved.y(), 0.0, 1e-15);
}

TEST(PlanarRegistration, FarFromTheOriginIsTheSame) {
  const Vector<2> far(4.5e5, 5.4e6);
  const GaussianMap<2> here = mapOf(roomWalls(), posesInRoom()), there = mapOf(roomWalls(), posesInRoom(), 30.0, far);
  const Pose truth = planarPose(3.0, 2.0, 0.8);
  Pose guess = planarPose(3.1, 1.9, 0.85);
  const std::vector<Eigen::Vector3d> scan = scanOf(roomWalls(), truth, 37);
  const Pose near = registerScan(scan, here, guess).pose;
  guess.translation.head<2>() += far;
  Pose found = registerScan(scan, there, guess).pose;
  found.translation.head<2>() -= far;
  EXPECT_LT(distanceBetween(found, near), 1e-4);
  EXPECT_LT(turnBetween(found, near), 1e-4);
}

TEST(PlanarRegistration, OfMapsUndoesAMotion) {
  const GaussianMap<2> map = mapOf(roomWalls(), posesInRoom());
  const Pose motion = planarPose(0.13, -0.21, 0.06);
  const GaussianMap<2> moved = transformMap(map, motion.inverse());
  const RegistrationResult result = registerMap(moved, map, Pose());
  expectPlanar(result);
  EXPECT_LT(distanceBetween(result.pose, motion), 0.003);
  EXPECT_LT(turnBetween(result.pose, motion), 0.001);
  EXPECT_NO_THROW(transformMap(moved, result.pose));
  Pose lifted;
  lifted.translation.z() = 0.1;
  EXPECT_THROW(registerMap(moved, map, lifted), std::invalid_argument);
  Pose tilted;
  tilted.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitX()));
  EXPECT_THROW(registerMap(moved, map, tilted), std::invalid_argument);
}

TEST(PlanarRegistration, OfNothingIsTheGuess) {
  const GaussianMap<2> map = mapOf(roomWalls(), posesInRoom());
  const Pose guess = planarPose(2, 3, 1), away = planarPose(200, 3, 1);
  for (const std::vector<Eigen::Vector3d>& points :
       {std::vector<Eigen::Vector3d>{}, std::vector<Eigen::Vector3d>{{std::nan(""), 0, 0}}}) {
    const RegistrationResult result = registerScan(points, map, guess);
    EXPECT_LT(distanceBetween(result.pose, guess), 1e-12);
    EXPECT_FALSE(result.converged);
    EXPECT_TRUE(result.degenerate);
  }
  const RegistrationResult lost = registerScan(scanOf(roomWalls(), guess, 1), map, away);  // no cell there
  EXPECT_LT(distanceBetween(lost.pose, away), 1e-12);
  EXPECT_FALSE(lost.converged);
  EXPECT_TRUE(lost.degenerate);
  EXPECT_EQ(lost.fitness, 0.0);
}

TEST(PlanarRegistration, RefusesBadInput) {
  const GaussianMap<2> map = mapOf(roomWalls(), posesInRoom());
  const std::vector<Eigen::Vector3d> scan = scanOf(roomWalls(), planarPose(2, 3, 1), 1);
  EXPECT_THROW(registerScan(scan, GaussianMap<2>(), {}), std::invalid_argument);
  Pose broken;
  broken.translation.x() = std::nan("");
  EXPECT_THROW(registerScan(scan, map, broken), std::invalid_argument);
  RegistrationOptions options;
  options.kernel = 0.0;
  EXPECT_THROW(registerScan(scan, map, {}, options), std::invalid_argument);
}

TEST(PlanarRegistration, WorksOnAMapOfOneScale) {
  std::vector<Vector<2>> points;
  for (std::size_t i = 0; i < 10; ++i)
    for (const Eigen::Vector3d& point : scanOf(roomWalls(), posesInRoom()[i], 100 + i))
      points.push_back((posesInRoom()[i] * point).head<2>());
  const GaussianMap<2> map = build<2>(points, {0.1, 10, 1, 0.0});
  const Pose truth = planarPose(3.0, 2.0, 0.8);
  const RegistrationResult result = registerScan(scanOf(roomWalls(), truth, 5), map, planarPose(3.02, 1.99, 0.81));
  EXPECT_LT(distanceBetween(result.pose, truth), 0.01);
  EXPECT_FALSE(result.degenerate);
}

}  // namespace
}  // namespace gaussmap
