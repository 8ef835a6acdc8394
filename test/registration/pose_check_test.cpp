// SPDX-License-Identifier: BSD-3-Clause
#include "registration/pose_check.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

namespace gaussmap::detail {
namespace {

/// A room of 9 m x 6 m x 3 m with a cupboard, as points on its walls, floor and ceiling [m], map frame.
std::vector<Eigen::Vector3d> roomPoints(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * double(random()) / 4294967295.0; };
  std::vector<Eigen::Vector3d> points;
  while (points.size() < count) {
    Eigen::Vector3d point(uniform(-1, 8), uniform(-2, 4), uniform(-1, 2));
    const unsigned face = random() % 8;
    if (face < 6) {
      const Eigen::Vector3d low(-1, -2, -1), high(8, 4, 2);
      const int axis = int(face / 2);
      point(axis) = face % 2 == 0 ? low(axis) : high(axis);
    } else {
      point = face == 6 ? Eigen::Vector3d(5, uniform(2.5, 4), uniform(-1, 1))
                        : Eigen::Vector3d(uniform(5, 8), 2.5, uniform(-1, 1));
    }
    points.push_back(point);
  }
  return points;
}

/// A robot that drives a curve through the room; it also rolls and pitches a little.
std::vector<Pose> curve(int count) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const Eigen::AngleAxisd yaw(0.2 + 0.17 * i, Eigen::Vector3d::UnitZ());
    const Eigen::AngleAxisd pitch(0.03 * i, Eigen::Vector3d::UnitY());
    poses.push_back({{0.5 + 0.6 * i, 0.1 + 0.07 * i * i, 0.05 * i}, Pose::Rotation(Eigen::Quaterniond(yaw * pitch))});
  }
  return poses;
}

/// Scans of the room from `truth`, which a program reads with the poses `read`.
MemoryScans scansOf(const std::vector<Pose>& truth, const std::vector<Pose>& read, bool points_in_map = false,
                    ScanFrame frame = ScanFrame::Sensor) {
  MemoryScans scans(frame);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    Scan scan;
    scan.points = roomPoints(3000, unsigned(i));
    if (!points_in_map)
      for (Eigen::Vector3d& point : scan.points) point = truth[i].inverse() * point;
    scan.pose = read[i];
    scans.add(scan);
  }
  return scans;
}

std::vector<Pose> changed(std::vector<Pose> poses, PoseConvention convention) {
  for (Pose& pose : poses) pose = poseAs(convention, pose);
  return poses;
}

TEST(PoseCheck, FindsNothingWrongWithTheRightPoses) {
  const std::vector<Pose> poses = curve(7);
  const PoseCheck check = checkPoses(scansOf(poses, poses));
  EXPECT_FALSE(check.better);
  EXPECT_GE(check.pairs, 4u);
}

TEST(PoseCheck, NamesEachMistake) {
  const std::vector<Pose> poses = curve(6);
  EXPECT_EQ(checkPoses(scansOf(poses, poses, true)).better, PoseConvention::NoMotion);
  EXPECT_EQ(checkPoses(scansOf(poses, poses, false, ScanFrame::Map)).better, PoseConvention::SensorToMap);
  EXPECT_EQ(checkPoses(scansOf(poses, changed(poses, PoseConvention::Inverse))).better, PoseConvention::Inverse);
  // A file with w first that is read as x y z w: what the reader takes for x is w.
  EXPECT_EQ(checkPoses(scansOf(poses, changed(poses, PoseConvention::WLast))).better, PoseConvention::WFirst);
  EXPECT_EQ(checkPoses(scansOf(poses, changed(poses, PoseConvention::WFirst))).better, PoseConvention::WLast);
  EXPECT_EQ(checkPoses(scansOf(poses, changed(poses, PoseConvention::Optical))).better, PoseConvention::Camera);
  EXPECT_EQ(checkPoses(scansOf(poses, changed(poses, PoseConvention::Camera))).better, PoseConvention::Optical);
}

TEST(PoseCheck, CountsThePiecesThatShowTheMistake) {
  const std::vector<Pose> poses = curve(6);
  const PoseCheck check = checkPoses(scansOf(poses, changed(poses, PoseConvention::Inverse)));
  EXPECT_GT(check.duel.other_only, 20 * check.duel.first_only);
  EXPECT_LE(check.duel.first_only + check.duel.other_only + check.duel.both, check.duel.pieces);
}

TEST(PoseCheck, AcceptsTheConventionThatTheProgramWasTold) {
  const std::vector<Pose> poses = curve(6);
  const MemoryScans scans = scansOf(poses, changed(poses, PoseConvention::Inverse));
  PoseCheckOptions options;
  options.convention = PoseConvention::Inverse;
  EXPECT_FALSE(checkPoses(scans, options).better);
  options.convention = PoseConvention::Camera;
  EXPECT_EQ(checkPoses(scans, options).better, PoseConvention::Inverse);
}

TEST(PoseCheck, SaysThatScansDoNotFitIfNoConventionExplainsIt) {
  const std::vector<Pose> truth = curve(6);
  std::vector<Pose> turned = truth, in_millimetres = truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // A sensor that is turned by 60 degrees on its carrier, whose poses the file holds.
    turned[i].rotation =
        Pose::Rotation(truth[i].rotation * Eigen::AngleAxisd(1.05, Eigen::Vector3d(0.2, 0.1, 1).normalized()));
    in_millimetres[i].translation *= 1000.0;
  }
  for (const std::vector<Pose>& wrong : {turned, in_millimetres}) {
    const PoseCheck check = checkPoses(scansOf(truth, wrong));
    EXPECT_FALSE(check.better) << int(check.better.value_or(PoseConvention::SensorToMap));
  }
  EXPECT_TRUE(checkPoses(scansOf(truth, turned)).doubtful);
  EXPECT_FALSE(checkPoses(scansOf(truth, truth)).doubtful);
}

TEST(PoseCheck, NamesNoConventionThatIsImpossible) {
  const std::vector<Pose> poses = curve(6);
  const MemoryScans scans = scansOf(poses, changed(poses, PoseConvention::WLast));
  PoseCheckOptions options;
  options.never = PoseConvention::WFirst;
  EXPECT_NE(checkPoses(scans, options).better, PoseConvention::WFirst);
}

TEST(PoseCheck, HasNothingToCompareWithoutMotion) {
  const std::vector<Pose> standing(5, curve(3).back());
  EXPECT_EQ(checkPoses(scansOf(standing, standing)).pairs, 0u);
  EXPECT_EQ(checkPoses(scansOf({curve(1)}, {curve(1)})).pairs, 0u);
  EXPECT_EQ(checkPoses(MemoryScans()).pairs, 0u);
}

TEST(PoseCheck, IsSilentAboutScansThatDoNotOverlap) {
  // Rooms of different sizes, 30 m apart.
  MemoryScans scans;
  for (int i = 0; i < 4; ++i) {
    Scan scan;
    scan.points = roomPoints(3000, unsigned(i));
    for (Eigen::Vector3d& point : scan.points) point *= 1.0 + 0.37 * ((i * 2) % 5);
    scan.pose.translation.x() = 30.0 * i;
    scans.add(scan);
  }
  EXPECT_FALSE(checkPoses(scans).better);
}

TEST(PoseCheck, DoesNotTakeTheBodyOfARobotForAMistake) {
  // Half of all points are on the carrier: they never move, as if the points were in the map frame.
  const std::vector<Pose> poses = curve(6);
  const MemoryScans room = scansOf(poses, poses);
  MemoryScans scans;
  std::mt19937 random(3);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Scan scan = room.read(i);
    for (int k = 0; k < 3000; ++k)
      scan.points.emplace_back(0.4, -0.3 + 0.6 * double(random() % 1000) / 1e3,
                               -0.5 + 0.3 * double(random() % 1000) / 1e3);
    scans.add(scan);
  }
  EXPECT_FALSE(checkPoses(scans).better);
}

TEST(PoseCheck, GivesTheSameResultWithAnyNumberOfThreads) {
  const std::vector<Pose> poses = curve(7);
  const MemoryScans scans = scansOf(poses, changed(poses, PoseConvention::Camera));
  PoseCheckOptions one, all;
  one.threads = 1;
  const PoseCheck a = checkPoses(scans, one), b = checkPoses(scans, all);
  EXPECT_EQ(a.better, b.better);
  EXPECT_EQ(a.duel.pieces, b.duel.pieces);
  EXPECT_EQ(a.duel.other_only, b.duel.other_only);
}

/// One turn of a planar laser in a room of 10 m x 6 m with an alcove: 400 points with z = 0 [m], map frame.
std::vector<Eigen::Vector3d> planPoints(std::mt19937& random) {
  const Eigen::Vector2d corners[] = {{-2, -1}, {8, -1}, {8, 3}, {6, 3}, {6, 5}, {-2, 5}, {-2, -1}};
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 400; ++i) {
    const std::size_t wall = random() % 6;
    const double share = double(random() % 10000) / 1e4;
    const Eigen::Vector2d point = corners[wall] + share * (corners[wall + 1] - corners[wall]);
    points.emplace_back(point.x(), point.y(), 0.0);
  }
  return points;
}

TEST(PoseCheck, ChecksPlanarLasers) {
  std::mt19937 random(1);
  std::vector<Pose> poses;
  for (int i = 0; i < 8; ++i)
    poses.push_back({{0.7 * i, 1.0 + 0.2 * i, 0.0},
                     Pose::Rotation(Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d::UnitZ())))});
  MemoryScans right, inverse, w_first, in_map;
  for (const Pose& pose : poses) {
    Scan scan;
    scan.points = planPoints(random);
    scan.pose = pose;
    in_map.add(scan);
    for (Eigen::Vector3d& point : scan.points) point = pose.inverse() * point;
    for (Eigen::Vector3d& point : scan.points) point.z() = 0.0;
    right.add(scan);
    scan.pose = pose.inverse();
    inverse.add(scan);
    scan.pose = poseAs(PoseConvention::WLast, pose);
    w_first.add(scan);
  }
  EXPECT_FALSE(checkPoses(right).better);
  EXPECT_EQ(checkPoses(in_map).better, PoseConvention::NoMotion);
  EXPECT_EQ(checkPoses(inverse).better, PoseConvention::Inverse);
  EXPECT_EQ(checkPoses(w_first).better, PoseConvention::WFirst);
}

TEST(PoseCheck, DoesNotCompareTheSlicesOfALaserThatLooksSideways) {
  // A scanner that measures profiles of a tunnel: all slices look alike, and each belongs to another place.
  std::mt19937 random(1);
  MemoryScans scans;
  for (int i = 0; i < 8; ++i) {
    Scan scan;
    scan.points = planPoints(random);
    scan.pose.translation.z() = 1.1 * i;
    scans.add(scan);
  }
  EXPECT_FALSE(checkPoses(scans).better);
}

}  // namespace
}  // namespace gaussmap::detail
