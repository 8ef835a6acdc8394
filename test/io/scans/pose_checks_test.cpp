// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/pose_checks.h"

#include "gaussmap/io/scans/file_scans.h"

#include <gtest/gtest.h>

#include <limits>

#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"

namespace gaussmap {
using namespace detail;

namespace {

ScanPose scanAt(double x, std::uint64_t fingerprint) {
  ScanPose scan;
  scan.path = "scan" + std::to_string(fingerprint) + ".pcd";
  scan.pose.translation.x() = x;
  scan.fingerprint = fingerprint;
  return scan;
}

std::string complaint(const ScanPose& scan) {
  try {
    diagnosePoses({scan});
    return "";
  } catch (const FileError& error) {
    return error.what();
  }
}

TEST(PoseDoctor, IsContentWithGoodPoses) {
  EXPECT_TRUE(diagnosePoses({}).warnings.empty());
  EXPECT_TRUE(diagnosePoses({scanAt(0, 1)}).warnings.empty());
  EXPECT_TRUE(diagnosePoses({scanAt(0, 1), scanAt(1, 2), scanAt(1, 3)}).warnings.empty());
}

TEST(PoseDoctor, WarnsOfPositionsThatLostDigits) {
  std::vector<ScanPose> scans = {scanAt(455123, 1), scanAt(455125, 2), scanAt(455127, 3)};
  EXPECT_TRUE(diagnosePoses(scans).warnings.empty());
  scans[1].position_step = 1.0;
  EXPECT_TRUE(diagnosePoses(scans).warnings.empty());
  scans[2].position_step = 10.0;
  const PoseDiagnosis diagnosis = diagnosePoses(scans);
  ASSERT_EQ(diagnosis.warnings.size(), 1u);
  EXPECT_NE(diagnosis.warnings[0].find("scan2.pcd and others: VIEWPOINT: the positions are rounded to steps of 10 m"),
            std::string::npos)
      << diagnosis.warnings[0];
}

TEST(PoseDoctor, WarnsIfAllScansStandAtOnePose) {
  const PoseDiagnosis diagnosis = diagnosePoses({scanAt(5, 1), scanAt(5, 2)});
  for (const char* const piece : {"all 2 scans", "(5 0 0", "VIEWPOINT", "--poses", "--frame map"})
    EXPECT_NE(diagnosis.same_pose.find(piece), std::string::npos) << diagnosis.same_pose;
}

TEST(PoseDoctor, DoesNotWarnOfCopiesOfOneScan) {
  EXPECT_EQ(diagnosePoses({scanAt(0, 1), scanAt(0, 1)}).same_pose, "");
}

TEST(PoseDoctor, WarnsIfSomeScansHaveNoPoseOfTheirOwn) {
  const PoseDiagnosis diagnosis = diagnosePoses({scanAt(1, 1), scanAt(0, 2), scanAt(0, 3), scanAt(2, 4)});
  ASSERT_EQ(diagnosis.warnings.size(), 1u);
  for (const char* const piece : {"2 of 4", "scan2.pcd", "scan3.pcd", "--poses"})
    EXPECT_NE(diagnosis.warnings[0].find(piece), std::string::npos) << diagnosis.warnings[0];
}

TEST(PoseDoctor, WarnsOfFarTranslations) {
  const PoseDiagnosis diagnosis = diagnosePoses({scanAt(2e8, 1), scanAt(1e7, 2)});
  ASSERT_EQ(diagnosis.warnings.size(), 1u);
  EXPECT_NE(diagnosis.warnings[0].find("scan1.pcd"), std::string::npos);
}

TEST(PoseDoctor, RefusesPosesThatCannotBeUsed) {
  ScanPose scan = scanAt(std::numeric_limits<double>::quiet_NaN(), 7);
  EXPECT_NE(complaint(scan).find("scan7.pcd: the translation"), std::string::npos);
  scan = scanAt(0, 7);
  scan.pose.rotation.coeffs().setZero();
  EXPECT_NE(complaint(scan).find("zero"), std::string::npos);
  scan.pose.rotation.w() = 0.9;
  EXPECT_NE(complaint(scan).find("norm 0.9"), std::string::npos);
  scan.pose.rotation.w() = std::numeric_limits<double>::infinity();
  EXPECT_NE(complaint(scan).find("not finite"), std::string::npos);
  scan.pose.rotation.w() = -0.9995;
  EXPECT_EQ(complaint(scan), "");
}

TEST(PoseDoctor, TakesThePoseOfAScanFromItsHeader) {
  const test::TemporaryDirectory directory;
  std::string bytes = test::xyzHeader(1, "ascii") + "1 2 3\n";
  bytes.replace(bytes.find("VIEWPOINT 0"), 11, "VIEWPOINT 8");
  const FoundScans found = findScans({directory.write("scan.pcd", bytes)});
  EXPECT_EQ(found.scans.info(0).pose.translation, Eigen::Vector3d(8, 0, 0));
  EXPECT_EQ(found.poses, "VIEWPOINT of each scan");
}

}  // namespace
}  // namespace gaussmap
