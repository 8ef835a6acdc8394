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

/// The warnings and reasons in one text.
std::string remarksOf(const PoseFile& file, const std::vector<std::string>& names, const PoseMatching& options = {}) {
  const MatchedPoses matched = matchPoses(file, keysOf(names), options);
  std::string text = matched.how + "\n";
  for (const std::string& warning : matched.warnings) text += warning + "\n";
  for (const MatchedPoses::Missing& missing : matched.missing) text += missing.reason + "\n";
  return text;
}

void expectIn(const std::string& piece, const std::string& text) {
  EXPECT_NE(text.find(piece), std::string::npos) << piece << " in: " << text;
}

TEST(PoseMatching, LimitsTheGapToHalfOfTheIntervalOfTheScans) {
  std::vector<std::string> tenth;  // every 0.1 s from 0 to 9.9 s, but not from 4.1 to 5.9 s
  for (int i = 0; i < 100; ++i)
    if (i <= 40 || i >= 60) tenth.push_back("170000000" + std::to_string(i / 10) + "." + std::to_string(i % 10));
  const std::vector<std::string> rare = {"1700000000.0.pcd", "1700000004.9.pcd", "1700000010.2.pcd"};
  EXPECT_EQ(linesFor(fileOf(tenth), rare, PoseMatch::Time), (Lines{1, 41, 81}));  // at most 2.65 s apart
  expectIn("1700000010.2.pcd is outside the times of the poses, by 300 ms", remarksOf(fileOf(tenth), rare));
  const std::vector<std::string> often = {"1700000004.0.pcd", "1700000004.5.pcd", "1700000005.0.pcd",
                                          "1700000005.5.pcd", "1700000010.0.pcd", "1700000010.5.pcd"};
  EXPECT_EQ(linesFor(fileOf(tenth), often, PoseMatch::Time), (Lines{41, 0, 0, 0, 81, 0}));  // at most 0.25 s apart
  PoseMatching options;
  options.interpolate = true;
  expectIn("1700000004.9.pcd is interpolated between poses 2 s apart", remarksOf(fileOf(tenth), rare, options));
}

TEST(PoseMatching, TakesRarePosesOnlyWithInterpolation) {
  const PoseFile file = fileOf({"1700000000.0", "1700000001.0", "1700000002.0", "1700000003.0"});
  const std::vector<std::string> names = {"1700000001.0.pcd", "1700000001.1.pcd", "1700000001.2.pcd",
                                          "1700000001.3.pcd", "1700000001.4.pcd", "1700000001.5.pcd",
                                          "1700000003.1.pcd"};
  EXPECT_EQ(linesFor(file, names, PoseMatch::Time), (Lines{2, 0, 0, 0, 0, 0, 0}));
  expectIn("500 ms from the nearest pose, at most 50 ms; with --interpolate it has a pose", remarksOf(file, names));
  PoseMatching options;
  options.interpolate = true;
  const Lines lines = linesFor(file, names, PoseMatch::Time, options), expected = {2, 2.1, 2.2, 2.3, 2.4, 2.5, 0};
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_NEAR(lines[i], expected[i], 1e-9);
}

TEST(PoseMatching, WarnsIfItInterpolatesOverAMissingPose) {
  const PoseFile file = fileOf({"1700000000.0", "1700000001.0", "1700000002.0", "1700000004.0", "1700000005.0"});
  PoseMatching options;
  options.interpolate = true;
  expectIn("1700000003.0.pcd is interpolated between poses 2 s apart, because a pose is missing there",
           remarksOf(file, {"1700000001.0.pcd", "1700000002.0.pcd", "1700000003.0.pcd"}, options));
  EXPECT_TRUE(matchPoses(file, keysOf({"1700000000.5.pcd", "1700000001.5.pcd"}), options).warnings.empty());
}

TEST(PoseMatching, NeverTakesAPoseOfAnotherYear) {
  const PoseFile file = fileOf({"1600000000.0", "1700000000.0"});
  EXPECT_EQ(linesFor(file, {"1600000100.0.pcd", "1700000000.0.pcd"}, PoseMatch::Time), (Lines{0, 2}));
  expectIn("100 s from the nearest pose, at most 10 s", remarksOf(file, {"1600000100.0.pcd", "1700000000.0.pcd"}));
}

TEST(PoseMatching, NamesTwoScansWithOneTimeOrOnePose) {
  const PoseFile file = fileOf({"1700000000.0", "1700000001.0", "1700000002.0"});
  expectIn("the scans front_1700000001.0.pcd and rear_1700000001.0.pcd have the same time, 1700000001 s",
           remarksOf(file, {"front_1700000000.0.pcd", "front_1700000001.0.pcd", "rear_1700000001.0.pcd"}));
  expectIn("the scans 1700000001.0.pcd and 1700000001.03.pcd get the same pose, that of line 2",
           remarksOf(file, {"1700000000.0.pcd", "1700000001.0.pcd", "1700000001.03.pcd", "1700000002.0.pcd"}));
  EXPECT_TRUE(matchPoses(file, keysOf({"1700000001.0.pcd", "1700000001.0.pcd", "1700000002.0.pcd"}))
                  .warnings.empty());  // one scan, twice
}

TEST(PoseMatching, GivesEachScanItsOwnPoseIfItsTimeHasSomethingBehindIt) {
  const PoseFile file = fileOf({"1700000000.0", "1700000000.5", "1700000001.0", "1700000001.5"});
  EXPECT_EQ(linesFor(file,
                     {"1700000000.000000_cloud.pcd", "1700000000.500000_cloud.pcd", "1700000001.000000_cloud.pcd",
                      "1700000001.500000_cloud.pcd"},
                     PoseMatch::Time),
            (Lines{1, 2, 3, 4}));
  const PoseFile start = fileOf({"0.1", "0.6", "1.1"});
  EXPECT_EQ(linesFor(start, {"0_100000000.pcd", "0_600000000.pcd", "1_100000000.pcd"}, PoseMatch::Time),
            (Lines{1, 2, 3}));
  EXPECT_EQ(linesFor(file, {"20231114_221320.pcd", "20231114_221321.pcd"}, PoseMatch::Time), (Lines{1, 3}));
  expectIn("dates in names are read as UTC", remarksOf(file, {"20231114_221320.pcd", "20231114_221321.pcd"}));
  expectIn("dates in names are read as UTC", remarksOf(file, {"20231114_231320.pcd", "20231114_231321.pcd"}));
}

TEST(PoseMatching, SortsLinesByTheirKeysBeforeItTakesTheirOrder) {
  EXPECT_EQ(linesFor(fileOf({"2.5", "0.5", "1.5"}), {"a.pcd", "b.pcd", "c.pcd"}, PoseMatch::Order), (Lines{2, 3, 1}));
  EXPECT_EQ(linesFor(fileOf({"12", "4", "7"}), {"a.pcd", "b.pcd", "c.pcd"}, PoseMatch::Order), (Lines{2, 3, 1}));
  const std::string remarks = remarksOf(fileOf({"2.5", "0.5", "1.5"}), {"a.pcd", "b.pcd", "c.pcd"});
  expectIn("sorted by times and matched by order", remarks);
  expectIn("not in the order of their times (line 2), so they are sorted before", remarks);
  EXPECT_THROW(matchPoses(fileOf({"2.5", "0.5", "0.5"}), keysOf({"a.pcd", "b.pcd", "c.pcd"})), FileError);
  EXPECT_EQ(linesFor(fileOf({"0.5", "0.5", "1.5"}), {"a.pcd", "b.pcd", "c.pcd"}, PoseMatch::Order), (Lines{1, 2, 3}));
  PoseMatching order;
  order.match = PoseMatch::Order;
  EXPECT_EQ(linesFor(fileOf({"2.5", "0.5"}), {"a.pcd", "b.pcd"}, PoseMatch::Order, order), (Lines{1, 2}));
  expectIn("but they are matched in the order of the file",
           remarksOf(fileOf({"2.5", "0.5"}), {"a.pcd", "b.pcd"}, order));
}

TEST(PoseMatching, SortsVerticesByTheirIds) {
  const TemporaryDirectory directory;
  const PoseFile file = readPoseFile(directory.write(
      "poses.g2o",
      "VERTEX_SE3:QUAT 3 1 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 2 0 0 0 0 0 1\nVERTEX_SE3:QUAT 2 3 0 0 0 0 0 1\n"));
  EXPECT_EQ(linesFor(file, {"0.pcd", "1.pcd", "2.pcd"}, PoseMatch::Order), (Lines{2, 3, 1}));
}

TEST(PoseMatching, TakesWholeDecimalsForNumbersOfScans) {
  const PoseFile file = fileOf({"0.000000", "1.000000", "2.000000", "3.000000"});
  EXPECT_EQ(linesFor(file, {"000001.pcd", "000003.pcd"}, PoseMatch::Index), (Lines{2, 4}));
  EXPECT_EQ(linesFor(file, {"1.5.pcd", "2.5.pcd"}, PoseMatch::Time), (Lines{3, 4}));
  EXPECT_EQ(linesFor(file, {"10.pcd", "20.pcd", "30.pcd", "40.pcd"}, PoseMatch::Order), (Lines{1, 2, 3, 4}));
}

TEST(PoseMatching, TellsWhichIndicesTheFileHas) {
  const PoseFile file = fileOf({"1", "2", "3"});
  expectIn("(the file has indices 1 to 3)", remarksOf(file, {"1.pcd", "2.pcd"}));
  expectIn("no index 0; the indices of the file start at 1", remarksOf(file, {"0.pcd", "1.pcd"}));
  const std::string remarks = remarksOf(file, {"2.pcd", "4.pcd"});
  expectIn("no index 4\n", remarks);
}

TEST(PoseMatching, TellsWhyItCannotTakeTheNumberOfTheLine) {
  try {
    matchPoses(kittiFile(3), keysOf({"00000a.pcd", "scan.pcd"}));
    FAIL();
  } catch (const FileError& error) {
    expectIn("have no number in common, for example '00000a.pcd' and 'scan.pcd'", error.what());
  }
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
