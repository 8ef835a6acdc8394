// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/scans/pose_file.h"

#include "gaussmap/core/scans.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

using test::TemporaryDirectory;
using Paths = std::vector<std::filesystem::path>;

PoseFile parse(const std::string& text) {
  const TemporaryDirectory directory;
  return readPoseFile(directory.write("poses.txt", text));
}

std::string complaint(const std::string& text) {
  try {
    parse(text);
    return "";
  } catch (const FileError& error) {
    return error.what();
  }
}

void expectRefused(const std::string& text, const std::vector<std::string>& pieces) {
  const std::string what = complaint(text);
  EXPECT_NE(what.find("poses.txt: "), std::string::npos) << what;
  for (const std::string& piece : pieces) EXPECT_NE(what.find(piece), std::string::npos) << piece << " in: " << what;
}

TEST(PoseFile, ReadsTum) {
  const PoseFile file = parse("# time x y z qx qy qz qw\n\n0.1 1 2 3 0 0 1 0\r\n0.2 4 5 6 0 0 0 1");
  ASSERT_EQ(file.entries.size(), 2u);
  EXPECT_FALSE(file.by_name);
  EXPECT_EQ(file.entries[0].line, 3u);
  EXPECT_EQ(file.entries[0].name, "0.1");
  EXPECT_EQ(file.entries[0].pose->translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(file.entries[0].pose->rotation.z(), 1.0);
  EXPECT_EQ(file.entries[1].pose->rotation.w(), 1.0);
}

TEST(PoseFile, ReadsKittiAsRowsOfAMatrix) {  // a quarter turn about z: x goes to y
  const PoseFile file = parse("0 -1 0 10 1 0 0 20 0 0 1 30\n");
  ASSERT_EQ(file.entries.size(), 1u);
  const Pose& pose = *file.entries[0].pose;
  EXPECT_EQ(pose.translation, Eigen::Vector3d(10, 20, 30));
  EXPECT_NEAR((pose.rotation.toRotationMatrix().col(0) - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-15);
}

TEST(PoseFile, TransformsPointsFromTheSensorToTheMap) {
  const PoseFile file = parse("0 -1 0 10 1 0 0 20 0 0 1 30\n");
  PointBlock<3> block;
  block.size = 1;
  block.coordinate[0][0] = 1.0;
  block.coordinate[1][0] = 2.0;
  block.coordinate[2][0] = 3.0;
  transform(*file.entries[0].pose, block);
  EXPECT_NEAR(block.coordinate[0][0], 8.0, 1e-12);
  EXPECT_NEAR(block.coordinate[1][0], 21.0, 1e-12);
  EXPECT_NEAR(block.coordinate[2][0], 33.0, 1e-12);
}

TEST(PoseFile, NormalisesSmallDeviations) {
  const PoseFile file = parse("0 0 0 0 0 0 0.7071 0.7071\n0 0 0 0 0 0 0 1.0009\n");
  for (const PoseFile::Entry& entry : file.entries) EXPECT_NEAR(entry.pose->rotation.norm(), 1.0, 1e-15);
}

TEST(PoseFile, RefusesWhatIsNoRotation) {
  expectRefused("# poses\n0 0 0 0 0 0 0 0\n", {"line 2", "zero"});
  expectRefused("0 0 0 0 0 0 0 1.1\n", {"line 1", "norm 1.1"});
  expectRefused("0 0 0 0 nan 0 0 1\n", {"line 1", "not finite"});
  expectRefused("0 inf 0 0 0 0 0 1\n", {"line 1", "translation", "not finite"});
  expectRefused("1 0 0 0 0 1 0 0 0 0 1.01 0\n", {"line 1", "not a rotation"});
  expectRefused("1 0 0 0 0 1 0 0 0 0 -1 0\n", {"line 1", "reflection"});
  expectRefused("1 0 0 nan 0 1 0 0 0 0 1 0\n", {"line 1", "not finite"});
  expectRefused("0 0 0 0 0 0 0 0 0 0 0 0\n", {"line 1", "not a rotation"});
}

TEST(PoseFile, RefusesLinesOfOtherLengths) {
  expectRefused("1 2 3\n", {"line 1", "3 numbers", "TUM", "KITTI"});
  expectRefused("hello\n", {"line 1", "1 word", "'hello'", "TUM", "KITTI"});
  expectRefused("0 1 2 3 0 0 0 1\n1 0 0 0 0 1 0 0 0 0 1 0\n", {"line 2", "another layout"});
  expectRefused("0 1 2 3 0 0 0 1\na.pcd 1 2 3 0 0 0 1\n", {"line 2", "another layout"});
  expectRefused("", {"no pose"});
  expectRefused("# nothing\n", {"no pose"});
}

TEST(PoseFile, GivesPosesInTheOrderOfTheFile) {
  const PoseFile file = parse("0 1 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n");
  const std::vector<Pose> poses = posesForScans(file, {"b.pcd", "a.pcd"});
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].translation.x(), 1.0);
  EXPECT_EQ(poses[1].translation.x(), 2.0);
  EXPECT_THROW(posesForScans(file, {"a.pcd"}), FileError);
  EXPECT_THROW(posesForScans(file, {"a.pcd", "b.pcd", "c.pcd"}), FileError);
}

TEST(PoseFile, GivesPosesByFileName) {
  const PoseFile file =
      parse("scans/b.pcd 2 0 0 0 0 0 1\na 1 0 0 0 0 0 1\nmy scan 3.pcd 3 0 0 0 0 0 1\nz 9 0 0 0 0 0 1\n");
  EXPECT_TRUE(file.by_name);
  EXPECT_EQ(file.entries[2].name, "my scan 3.pcd");
  const std::vector<Pose> poses = posesForScans(file, {"/data/a.pcd", "my scan 3.pcd", "b.pcd"});
  ASSERT_EQ(poses.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(poses[i].translation.x(), std::vector<double>({1, 3, 2})[i]);
  EXPECT_THROW(posesForScans(file, {"a.pcd", "c.pcd"}), FileError);
  EXPECT_THROW(posesForScans(file, {"one/a.pcd", "two/a.pcd"}), FileError);
}

TEST(PoseFile, ReadsMatricesBehindFileNames) {
  EXPECT_EQ(parse("a.pcd 1 0 0 5 0 1 0 0 0 0 1 0\n").entries[0].name, "a.pcd");
  const PoseFile numbered = parse("000002 1 0 0 5 0 1 0 0 0 0 1 0\n000001 1 0 0 6 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(posesForScans(numbered, {"000001.pcd"}).front().translation.x(), 6.0);
}

TEST(PoseFile, TakesTimesThatNameAllScansAsNames) {
  const PoseFile file = parse("10.5 1 0 0 0 0 0 1\n9.5 2 0 0 0 0 0 1\n");
  EXPECT_EQ(posesForScans(file, {"9.5.pcd", "10.5.pcd"})[0].translation.x(), 2.0);
  EXPECT_EQ(posesForScans(file, {"9.5.pcd", "other.pcd"})[0].translation.x(), 1.0);
}

TEST(PoseFile, RefusesAnAmbiguousName) {
  expectRefused("a.pcd 1 0 0 0 0 0 1\na.pcd 2 0 0 0 0 0 1\n", {"line 2", "'a.pcd'", "line 1"});
  expectRefused("one/a.pcd 1 0 0 0 0 0 1\n../one/a.pcd 2 0 0 0 0 0 1\n", {"line 2", "'one/a.pcd'"});
}

TEST(PoseFile, RefusesWhatIsNoFile) {
  EXPECT_THROW(readPoseFile(TemporaryDirectory().path()), FileError);
}

}  // namespace
}  // namespace gaussmap
