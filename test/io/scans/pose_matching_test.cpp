// SPDX-License-Identifier: BSD-3-Clause
// Which scan gets which pose. The x of a pose is the number of its line.
#include <gtest/gtest.h>

#include <cmath>

#include "gaussmap/io/scans/pose_file.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

using test::TemporaryDirectory;
using Lines = std::vector<double>;

/// A file with these keys in front of the poses.
PoseFile fileOf(const std::vector<std::string>& keys, const std::string& behind = "") {
  std::string text;
  for (std::size_t i = 0; i < keys.size(); ++i)
    text += keys[i] + " " + std::to_string(i + 1) + " 0 0 0 0 0 1" + behind + "\n";
  const TemporaryDirectory directory;
  return readPoseFile(directory.write("poses.txt", text));
}

PoseFile kittiFile(std::size_t lines) {
  std::string text;
  for (std::size_t i = 1; i <= lines; ++i) text += "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0\n";
  const TemporaryDirectory directory;
  return readPoseFile(directory.write("poses.txt", text));
}

std::vector<ScanKey> keysOf(const std::vector<std::string>& names) {
  std::vector<ScanKey> keys;
  for (const std::string& name : names) keys.push_back({name, std::nullopt});
  return keys;
}

/// The lines that the scans get; 0 for a scan without a pose.
Lines linesFor(const PoseFile& file, const std::vector<std::string>& names, PoseMatch expected,
               const PoseMatching& options = {}) {
  const MatchedPoses matched = matchPoses(file, keysOf(names), options);
  EXPECT_EQ(matched.match, expected) << matched.how;
  Lines lines;
  for (const std::optional<Pose>& pose : matched.poses) lines.push_back(pose ? pose->translation.x() : 0.0);
  return lines;
}

TEST(PoseMatching, TakesTheNearestTimeInEveryUnit) {
  const PoseFile seconds = fileOf({"1700000000.1", "1700000000.2", "1700000000.3", "1700000000.4"});
  for (const std::vector<std::string>& names :
       std::vector<std::vector<std::string>>{{"1700000000.3001.pcd", "1700000000.1002.pcd"},
                                             {"1700000000300.pcd", "1700000000100.pcd"},
                                             {"1700000000300100.pcd", "1700000000100200.pcd"},
                                             {"1700000000300100000.pcd", "1700000000100200000.pcd"},
                                             {"lidar_1700000000_300100000.pcd", "lidar_1700000000_100200000.pcd"}})
    EXPECT_EQ(linesFor(seconds, names, PoseMatch::Time), (Lines{3, 1})) << names.front();
  const PoseFile nanoseconds = fileOf({"1700000000100000000", "1700000000200000000"});
  EXPECT_EQ(linesFor(nanoseconds, {"1700000000.2.pcd", "1700000000.1.pcd"}, PoseMatch::Time), (Lines{2, 1}));
}

TEST(PoseMatching, KeepsNanosecondsApart) {
  const PoseFile file = fileOf({"1700000000000000001", "1700000000000000002", "1700000000000000004"});
  EXPECT_EQ(linesFor(file, {"1700000000000000002.pcd", "1700000000000000004.pcd", "1700000000000000001.pcd"},
                     PoseMatch::Time),
            (Lines{2, 3, 1}));
}

TEST(PoseMatching, FindsTheUnitOfTimesSinceTheStart) {
  const PoseFile file = fileOf({"100.0", "100.5", "101.0"});
  EXPECT_EQ(linesFor(file, {"100500000000.pcd", "101000000000.pcd"}, PoseMatch::Time), (Lines{2, 3}));  // ns
  EXPECT_EQ(linesFor(file, {"100.5.pcd", "101.0.pcd"}, PoseMatch::Time), (Lines{2, 3}));
}

TEST(PoseMatching, LeavesScansFarFromAllPosesWithoutAPose) {
  const PoseFile file = fileOf({"1700000001.5", "1700000002.0", "1700000002.5"});
  const std::vector<std::string> names = {"1700000001.0.pcd", "1700000001.5.pcd", "1700000002.0.pcd"};
  EXPECT_EQ(linesFor(file, names, PoseMatch::Time), (Lines{0, 1, 2}));  // as many poses as scans, but not in order
  const MatchedPoses matched = matchPoses(file, keysOf(names));
  ASSERT_EQ(matched.missing.size(), 1u);
  EXPECT_EQ(matched.missing[0].scan, 0u);
  EXPECT_NE(matched.missing[0].reason.find("500 ms"), std::string::npos);
  PoseMatching wider;
  wider.max_time_gap = 0.5;
  EXPECT_EQ(linesFor(file, names, PoseMatch::Time, wider), (Lines{1, 1, 2}));
}

TEST(PoseMatching, Interpolates) {
  const TemporaryDirectory directory;
  const PoseFile file = readPoseFile(directory.write(
      "poses.txt",
      "1700000000.0 2 0 0 0 0 0 1\n1700000001.0 4 0 0 0 0 0.70710678 0.70710678\n1700000002.0 4 0 0 0 0 0 1\n"));
  PoseMatching options;
  options.interpolate = true;
  const MatchedPoses matched = matchPoses(file, keysOf({"1700000000.25.pcd", "1700000001.0.pcd"}), options);
  EXPECT_NEAR(matched.poses[0]->translation.x(), 2.5, 1e-12);
  EXPECT_NEAR(matched.poses[0]->rotation.z(), std::sin(std::acos(-1.0) / 16), 1e-7);  // a quarter of 90 degrees
  EXPECT_NEAR(matched.poses[1]->translation.x(), 4.0, 1e-12);
  EXPECT_TRUE(matched.warnings.empty());
  const MatchedPoses nearest = matchPoses(file, keysOf({"1700000000.25.pcd", "1700000001.0.pcd"}));
  ASSERT_EQ(nearest.warnings.size(), 1u);  // 0.5 m off
  EXPECT_NE(nearest.warnings[0].find("--interpolate"), std::string::npos);
}

TEST(PoseMatching, RefusesTwoPosesOfOneTime) {
  EXPECT_THROW(matchPoses(fileOf({"1700000000.5", "1700000000.5"}), keysOf({"1700000000.5.pcd"})), FileError);
}

TEST(PoseMatching, TakesTheNumberOfTheNameAsIndexOrLine) {
  EXPECT_EQ(linesFor(kittiFile(9), {"000007.pcd", "000002.pcd"}, PoseMatch::Index), (Lines{8, 3}));
  EXPECT_EQ(linesFor(fileOf({"2", "4", "7"}), {"000007.pcd", "000002.pcd"}, PoseMatch::Index), (Lines{3, 1}));
  EXPECT_EQ(linesFor(fileOf({"2", "4", "7"}), {"scan_2.pcd", "scan_5.pcd", "scan_7.pcd"}, PoseMatch::Index),
            (Lines{1, 0, 3}));
  EXPECT_EQ(linesFor(kittiFile(3), {"1.pcd", "2.pcd", "3.pcd"}, PoseMatch::Order), (Lines{1, 2, 3}));
  EXPECT_THROW(matchPoses(fileOf({"2", "2", "7"}), keysOf({"2.pcd"})), FileError);
}

TEST(PoseMatching, TakesIdsBehindThePoseForIndicesOnlyIfAllScansHaveOne) {
  const std::string text = "0.5 1 0 0 0 0 0 1 1\n1.5 2 0 0 0 0 0 1 2\n2.5 3 0 0 0 0 0 1 3\n";
  const TemporaryDirectory directory;
  const PoseFile file = readPoseFile(directory.write("poses.txt", text));
  EXPECT_EQ(linesFor(file, {"3.pcd", "1.pcd"}, PoseMatch::Index), (Lines{3, 1}));
  EXPECT_EQ(linesFor(file, {"0.pcd", "1.pcd", "2.pcd"}, PoseMatch::Order), (Lines{1, 2, 3}));
}

TEST(PoseMatching, TakesWholeTimesForNumbersOfScansOnlyIfAllScansHaveOne) {
  const TemporaryDirectory directory;
  const PoseFile file =
      readPoseFile(directory.write("poses.txt", "# time x y z qx qy qz qw\n4 1 0 0 0 0 0 1\n7 2 0 0 0 0 0 1\n"));
  EXPECT_EQ(linesFor(file, {"7.pcd"}, PoseMatch::Index), (Lines{2}));
  EXPECT_EQ(linesFor(file, {"1.pcd", "2.pcd"}, PoseMatch::Order), (Lines{1, 2}));
}

TEST(PoseMatching, TakesTheOrderOnlyWithoutCommonKeysAndWithEqualCounts) {
  EXPECT_EQ(linesFor(fileOf({"0.5", "1.5"}), {"b.pcd", "a.pcd"}, PoseMatch::Order), (Lines{1, 2}));
  EXPECT_EQ(linesFor(kittiFile(2), {"1700000000.5.pcd", "1700000001.5.pcd"}, PoseMatch::Order), (Lines{1, 2}));
  EXPECT_THROW(matchPoses(fileOf({"0.5", "1.5", "2.5"}), keysOf({"b.pcd", "a.pcd"})), FileError);
  EXPECT_THROW(matchPoses(kittiFile(3), keysOf({"b.pcd", "a.pcd"})), FileError);
  PoseMatching order;
  order.match = PoseMatch::Order;
  EXPECT_EQ(linesFor(fileOf({"4", "7"}), {"1.pcd", "2.pcd"}, PoseMatch::Order, order), (Lines{1, 2}));
}

TEST(PoseMatching, TakesNamesWithoutTheirEndings) {
  const PoseFile file = fileOf({"b.png", "a.png", "c.png"});
  EXPECT_EQ(linesFor(file, {"a.pcd", "c.pcd", "d.pcd"}, PoseMatch::Name), (Lines{2, 3, 0}));
}

TEST(PoseMatching, GivesNoPoseForALineOfNaN) {
  const TemporaryDirectory directory;
  const PoseFile file =
      readPoseFile(directory.write("poses.txt", "0.5 1 0 0 0 0 0 1\n1.5 nan nan nan nan nan nan nan\n"));
  const MatchedPoses matched = matchPoses(file, keysOf({"a.pcd", "b.pcd"}));
  ASSERT_EQ(matched.missing.size(), 1u);
  EXPECT_NE(matched.missing[0].reason.find("line 2"), std::string::npos);
}

}  // namespace
}  // namespace gaussmap
