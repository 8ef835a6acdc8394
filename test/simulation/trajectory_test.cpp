// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/trajectory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gaussmap/io/scans/pose_file.h"
#include "io/files/temporary_directory.h"
#include "simulation/simulation.h"

namespace gaussmap {
namespace {

TEST(WriteTum, WritesWhatThePoseReaderReads) {
  const test::TemporaryDirectory directory;
  const std::vector<TimedPose> trajectory = makeSimulation(WorldName::Street).trajectory;
  const std::filesystem::path path = directory.path() / "trajectory.tum";
  writeTum(path, trajectory);
  const PoseFile file = readPoseFile(path);
  ASSERT_EQ(file.entries.size(), trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_EQ(std::stod(file.entries[i].name), trajectory[i].time);
    EXPECT_EQ(file.entries[i].pose->translation, trajectory[i].pose.translation);
    EXPECT_LT(file.entries[i].pose->rotation.angularDistance(trajectory[i].pose.rotation), 1e-7);
  }
}

TEST(WriteTum, RefusesFaultsAndLeavesNoFile) {
  const test::TemporaryDirectory directory;
  const std::filesystem::path path = directory.path() / "trajectory.tum";
  Pose zero;
  zero.rotation.coeffs().setZero();
  EXPECT_THROW(writeTum(path, {{0.0, Pose()}, {1.0, zero}}), std::invalid_argument);
  EXPECT_THROW(writeTum(path, {{std::nan(""), Pose()}}), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_THROW(writeTum(directory.path() / "none" / "x.tum", {}), FileError);
}

}  // namespace
}  // namespace gaussmap
