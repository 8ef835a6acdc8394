// SPDX-License-Identifier: BSD-3-Clause
// Every usual kind of pose file. The pose is a quarter turn about z at (4, 5, 6), unless a test says otherwise.
#include <gtest/gtest.h>

#include <cmath>

#include "gaussmap/io/scans/file_scans.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

using test::TemporaryDirectory;

PoseFile parse(const std::string& text, PoseFormat format = PoseFormat::Automatic, const std::string& columns = "") {
  const TemporaryDirectory directory;
  return readPoseFile(directory.write("poses.txt", text), format, columns);
}

void expectQuarterTurn(const PoseFile& file, std::size_t i = 0) {
  ASSERT_GT(file.entries.size(), i);
  ASSERT_TRUE(file.entries[i].pose);
  const Pose& pose = *file.entries[i].pose;
  EXPECT_EQ(pose.translation, Eigen::Vector3d(4, 5, 6)) << file.layout;
  EXPECT_NEAR((pose.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-3) << file.layout;
}

std::string complaint(const std::string& text, PoseFormat format = PoseFormat::Automatic) {
  try {
    parse(text, format);
    return "";
  } catch (const FileError& error) {
    return error.what();
  }
}

void expectRefused(const std::string& text, const std::vector<std::string>& pieces) {
  const std::string what = complaint(text);
  for (const std::string& piece : pieces) EXPECT_NE(what.find(piece), std::string::npos) << piece << " in: " << what;
}

const std::string kQuaternion = "4 5 6 0 0 0.70711 0.70711", kMatrix = "0 -1 0 4 1 0 0 5 0 0 1 6";

std::string withCommas(std::string text, const std::string& separator = ",") {
  for (std::size_t i = text.find(' '); i != std::string::npos; i = text.find(' ', i + separator.size()))
    text.replace(i, 1, separator);
  return text;
}

TEST(PoseKinds, SeparatesByBlanksTabsCommasAndSemicolons) {
  for (const char* const separator : {" ", "\t", ",", ", ", ";", " ; "}) {
    const PoseFile file = parse(withCommas("0.5 " + kQuaternion, separator) + "\n");
    expectQuarterTurn(file);
    EXPECT_EQ(file.format, PoseFormat::Tum);
    EXPECT_EQ(file.entries[0].time, std::chrono::milliseconds(500));
  }
  expectQuarterTurn(parse(withCommas("0.5 " + kQuaternion) + ",\r\n"));
}

TEST(PoseKinds, ReadsMatricesInOneLine) {
  for (const std::string key : {"", "7 ", "7.5 ", "1700000000500000000 ", "7 1700000000.5 "}) {
    for (const std::string row : {"", " 0 0 0 1"}) {
      const PoseFile file = parse(key + kMatrix + row + "\n");
      expectQuarterTurn(file);
      EXPECT_EQ(file.format, row.empty() ? PoseFormat::Kitti : PoseFormat::Matrix4);
      EXPECT_EQ(file.entries[0].index.has_value(), key.substr(0, 2) == "7 ");
      EXPECT_EQ(file.entries[0].time.has_value(), key.size() > 2);
    }
  }
}

TEST(PoseKinds, ReadsMatricesOverSeveralLines) {
  const std::string rows = "0 -1 0 4\n1 0 0 5\n0 0 1 6\n", last = "0 0 0 1\n";
  for (const std::string& text : {rows + last + rows + last, rows + last + "\n" + rows + last, rows + rows,
                                  withCommas(rows + last + rows + last)}) {
    const PoseFile file = parse(text);
    EXPECT_EQ(file.entries.size(), 2u);
    expectQuarterTurn(file, 1);
    EXPECT_EQ(file.format, PoseFormat::Matrix4);
  }
  const PoseFile open3d = parse("0 0 1\n" + rows + last + "5 5 6\n" + rows + last);
  expectQuarterTurn(open3d, 1);
  EXPECT_EQ(open3d.entries[1].index, 5u);
  const PoseFile balm = parse(rows + "0 0 0 1700000000.5\n" + rows + "0 0 0 1700000001.5\n");
  EXPECT_EQ(balm.entries[1].time, std::chrono::milliseconds(1700000001500));
  EXPECT_NE(complaint(rows + last + "0 -1 0 4\n"), "");
  EXPECT_NE(complaint(rows + last + rows + "1 0 0 1\n"), "");
}

TEST(PoseKinds, TakesTheColumnsOfAHeader) {
  const struct {
    const char *header, *line;
  } files[] = {
      {"timestamp,x,y,z,qx,qy,qz,qw", "0.5,4,5,6,0,0,0.70711,0.70711"},
      {"#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v_RS_R_x [m "
       "s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1]",
       "500000000,4,5,6,0.70711,0,0,0.70711,9,9,9"},
      {"# time tx ty tz qw qx qy qz", "0.5 4 5 6 0.70711 0 0 0.70711"},
      {"# format: time x y z q0 q1 q2 q3", "0.5 4 5 6 0.70711 0 0 0.70711"},
      {"qx;qy;qz;qw;pos_x;pos_y;pos_z;stamp_ms", "0;0;0.70711;0.70711;4;5;6;500"},
      {"#sec,nsec,x,y,z,qx,qy,qz,qw", "0,500000000,4,5,6,0,0,0.70711,0.70711"},
      {"t_ns,x,y,z,roll_deg,pitch_deg,yaw_deg", "500000000,4,5,6,0,0,90"},
      {"time x y z roll[rad] pitch[rad] yaw[rad]", "0.5 4 5 6 0 0 1.570796"},
      {"utime,x,y,z,yaw [deg],pitch [deg],roll [deg]", "500000,4,5,6,90,0,0"},
      {"time,r11,r12,r13,r21,r22,r23,r31,r32,r33,tx,ty,tz", "0.5,0,-1,0,1,0,0,0,0,1,4,5,6"},
      {"time m00 m01 m02 m03 m10 m11 m12 m13 m20 m21 m22 m23", "0.5 0 -1 0 4 1 0 0 5 0 0 1 6"},
      {"%time,field.header.seq,field.header.stamp,field.header.frame_id,field.pose.pose.position.x,"
       "field.pose.pose.position.y,field.pose.pose.position.z,field.pose.pose.orientation.x,"
       "field.pose.pose.orientation.y,field.pose.pose.orientation.z,field.pose.pose.orientation.w,"
       "field.pose.covariance0,field.twist.twist.linear.x",
       "900000000,3,500000000,odom,4,5,6,0,0,0.70711,0.70711,1,9"},
  };
  for (const auto& [header, line] : files) {
    const PoseFile file = parse(std::string(header) + "\n" + line + "\n");
    expectQuarterTurn(file);
    if (std::string(header).find("field") != std::string::npos) continue;  // rostopic has ns without a name for them
    EXPECT_EQ(file.entries[0].time, std::chrono::milliseconds(500)) << header;
  }
}

TEST(PoseKinds, ReadsIndicesInFrontAndBehind) {
  EXPECT_EQ(parse("12 " + kQuaternion + "\n").entries[0].index, 12u);
  const PoseFile both = parse("12 1700000000.5 " + kQuaternion + "\n13 1700000001.5 " + kQuaternion + "\n");
  EXPECT_EQ(both.entries[1].index, 13u);
  EXPECT_EQ(both.entries[1].time, std::chrono::milliseconds(1700000001500));
  const PoseFile behind = parse("0.5 " + kQuaternion + " 12\n1.5 " + kQuaternion + " 13\n");
  expectQuarterTurn(behind);
  EXPECT_EQ(behind.entries[1].index, 13u);
  EXPECT_TRUE(behind.indices_may_be_ids);
  EXPECT_TRUE(parse("#stamp x y z qx qy qz qw id\n0.5 " + kQuaternion + " 12\n").indices_may_be_ids);
  EXPECT_FALSE(parse("num,t,x,y,z,qx,qy,qz,qw\n3,0.5,4,5,6,0,0,0.70711,0.70711\n").indices_may_be_ids);
  EXPECT_FALSE(parse("12.5 " + kQuaternion + "\n").entries[0].index);  // a time
}

TEST(PoseKinds, ReadsWholeDecimalsAsTimesAndIndices) {
  for (const std::string key : {"12.0", "12.000000", "1.200000000000000000e+01"}) {
    const PoseFile file = parse(key + " " + kQuaternion + "\n");
    EXPECT_EQ(file.entries[0].index, 12u) << key;
    EXPECT_EQ(file.entries[0].time, std::chrono::seconds(12)) << key;
    EXPECT_TRUE(file.indices_may_be_ids);
    EXPECT_EQ(file.layout, "time x y z qx qy qz qw");
  }
  EXPECT_FALSE(parse("1700000000.0 " + kQuaternion + "\n").entries[0].index);
  EXPECT_FALSE(parse("12.0 " + kQuaternion + "\n12.5 " + kQuaternion + "\n").entries[0].index);
}

TEST(PoseKinds, DropsCommentsBehindTheNumbers) {
  for (const char* const comment : {" # scan", "\t# 1 2 3", " // x", " % x"}) {
    expectQuarterTurn(parse("0.5 " + kQuaternion + comment + "\n"));
    expectQuarterTurn(parse("a #1.pcd " + kQuaternion + comment + "\n"));
    expectQuarterTurn(parse(withCommas("0.5 " + kQuaternion) + comment + "\n"));
    expectQuarterTurn(parse(kMatrix + comment + "\n"));
  }
  EXPECT_EQ(parse("run 5 #2.pcd " + kQuaternion + "\n").entries[0].name, "run 5 #2.pcd");
}

TEST(PoseKinds, RecognisesEuRocWithoutItsHeader) {
  const std::string line = "4 5 6 0.70711 0 0 0.70711 0.1 0.2 0.3 -0.002 0.02 0.07 -0.01 0.1 0.09\n";
  for (const PoseFormat format : {PoseFormat::Automatic, PoseFormat::EuRoc}) {
    const PoseFile file = parse(withCommas("1700000000500000000 " + line), format);
    expectQuarterTurn(file);
    EXPECT_EQ(file.format, PoseFormat::EuRoc);
    EXPECT_EQ(file.entries[0].time, std::chrono::milliseconds(1700000000500));
  }
  expectRefused("1700000000.5 " + line, {"line 1", "17 numbers: EuRoC?", "--pose-format euroc"});
}

TEST(PoseKinds, RefusesMatricesWrittenColumnByColumn) {
  const std::string by_columns = "0 1 0 0 -1 0 0 0 0 0 1 0 4 5 6 1";
  for (const std::string key : {"", "7 ", "1700000000.5 ", "a.pcd "})
    expectRefused(key + by_columns + "\n",
                  {"line 1", "the last row of the 4 x 4 matrix is 4 5 6 1", "column by column?"});
  expectRefused("0 1 0 0\n-1 0 0 0\n0 0 1 0\n4 5 6 1\n", {"the last row of the 4 x 4 matrix is 4 5 6 1", "column"});
  expectRefused("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n4 5 6 1\n", {"line 8", "4 5 6 1"});
  expectRefused(kMatrix + " 0 0 0 1\n" + kMatrix + " 0 0 0 2\n", {"line 2", "is 0 0 0 2 instead of 0 0 0 1"});
  EXPECT_FALSE(
      parse(kMatrix + " 0 0 0 1\n" + withCommas("nan", "") + " nan nan nan nan nan nan nan nan nan nan nan 0 0 0 1\n")
          .entries[1]
          .pose);
}

TEST(PoseKinds, NamesTheMistakeOfOtherTables) {
  expectRefused("1700000000.5 1 2 3\n1700000001.5 2 2 3\n1700000002.5 3 2 3\n", {"4 numbers per line: no rotation"});
  expectRefused("0.0 1 2 0.1\n0.5 2 2 0.1\n1.0 3 2 0.1\n1.5 3 2 0.1\n", {"4 numbers per line: no rotation"});
  const std::string commas = "0,5 4,5 5,5 6,5 0,0 0,0 0,7 0,7";
  for (const char* const separator : {" ", "\t", ";"})
    for (const std::string key : {"", "a.pcd "})
      expectRefused(withCommas(key + commas, separator) + "\n", {"line 1", "decimal comma: write 0.5, not 0,5"});
  expectRefused(std::string("\xFF\xFE") + "0", {"the file is UTF-16: save it as UTF-8"});
  expectRefused(std::string("0\0.\0", 4), {"UTF-16"});
  const std::string image = "1 0.70711 0 0 0.70711 4 5 6 1 000000.png\n100.5 200.5 -1\n";
  expectRefused(image, {"line 1", "COLMAP"});
  expectRefused("#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n" + image, {"COLMAP"});
}

TEST(PoseKinds, WarnsOfRoundedPositions) {
  const struct {
    const char *first, *second, *step;
  } files[] = {
      {"1 455123 5.40457e+06 310", "2 455125 5.40457e+06 310.2", "10 m"},  // std::ostream
      {"1 4.551234e+05 5.404568e+06 3.100000e+02", "2 4.551254e+05 5.404569e+06 3.101000e+02", "1 m"},
      {"1 3000.12 52000.1 12", "2 3001.12 52000.2 12", "0.1 m"},
  };
  for (const auto& [first, second, step] : files) {
    const PoseFile file = parse(std::string(first) + " 0 0 0 1\n" + second + " 0 0 0 1\n");
    ASSERT_EQ(file.warnings.size(), 1u) << first;
    EXPECT_NE(file.warnings[0].find("rounded to steps of " + std::string(step)), std::string::npos) << file.warnings[0];
  }
  EXPECT_EQ(parse("1 0 0 455123 0 1 0 5404567 0 0 1 310\n1 0 0 455124 0 1 0 5404568 0 0 1 310\n").warnings.size(), 1u);
  const std::string block = "1 0 0 455123\n0 1 0 5404567\n0 0 1 310\n0 0 0 1\n";
  EXPECT_EQ(parse(block + block).warnings.size(), 1u);
  const std::string vertex = " 455123 5404567 310 0 0 0 1\n";
  EXPECT_EQ(parse("VERTEX_SE3:QUAT 0" + vertex + "VERTEX_SE3:QUAT 1" + vertex).warnings.size(), 1u);
  for (const char* const exact :
       {"455123.12 5404567.81 310.00", "455123.0 5404567.5 310.0", "100000 200000 0", "123.456 1.5 0", "1234.56 1 0",
        "4.551234567e+05 5.404567891e+06 3.1e+02", "999.999 0.1 0"})
    EXPECT_TRUE(parse(std::string("1 ") + exact + " 0 0 0 1\n2 " + exact + " 0 0 0 1\n").warnings.empty()) << exact;
  EXPECT_TRUE(parse("1 455123 5.40457e+06 310 0 0 0 1\n").warnings.empty());  // one alone can be exact
}

TEST(PoseKinds, ReadsSecondsAndNanosecondsWithoutAHeader) {
  const PoseFile file = parse("1700000000,5,4,5,6,0,0,0.70711,0.70711\n1700000001,7,4,5,6,0,0,0.70711,0.70711\n");
  expectQuarterTurn(file);
  EXPECT_EQ(file.entries[0].time->count(), 1700000000000000005);
}

TEST(PoseKinds, ReadsPoseGraphs) {
  const PoseFile file =
      parse("VERTEX_SE3:QUAT 8 " + kQuaternion + "\nFIX 8\nVERTEX_SE2 9 4 5 1.570796\nEDGE_SE2 8 9 1 2 3\n");
  expectQuarterTurn(file);
  EXPECT_EQ(file.format, PoseFormat::G2o);
  ASSERT_EQ(file.entries.size(), 2u);
  EXPECT_EQ(file.entries[1].index, 9u);
  EXPECT_NEAR(file.entries[1].pose->rotation.z(), std::sqrt(0.5), 1e-6);
  expectRefused("VERTEX3 0 1 2 3 0 0 0\n", {"VERTEX3", "not supported"});
  expectRefused("VERTEX_SE3:QUAT 0 1 2 3\n", {"line 1", "index x y z qx qy qz qw"});
}

TEST(PoseKinds, HasNoPoseForALineOfNaN) {
  const PoseFile file = parse("0.5 " + kQuaternion + "\n1.5 nan nan nan nan nan nan nan\n2.5 " + kQuaternion + "\n");
  EXPECT_FALSE(file.entries[1].pose);
  expectQuarterTurn(file, 2);
  EXPECT_FALSE(parse(withCommas("NaN NaN NaN NaN NaN NaN NaN NaN NaN NaN NaN NaN\n" + kMatrix) + "\n").entries[0].pose);
}

TEST(PoseKinds, RefusesWhatIsNotClear) {
  expectRefused("0.5 4 5 6 0.1 0.2 0.3\n", {"line 1", "roll pitch yaw", "unit", "--pose-format xyzrpy-deg"});
  expectRefused("4 5 6 0.1 0.2 0.3\n", {"roll pitch yaw", "unit"});
  expectRefused("time,x,y,z,roll,pitch,yaw\n0.5,4,5,6,1,2,3\n", {"unit", "xyzrpy-rad"});
  expectRefused("time,a,b,c\n0.5,4,5,6\n", {"line 1", "no columns x, y and z", "--pose-format"});
  expectRefused("0.5 4 5 6 0.70711 0 0 0.70711 9 9 9\n", {"11 numbers", "--pose-format"});
  expectRefused("1 2.5 3 1 0 0 0 1 0\n", {" or ", "--pose-format"});  // an id behind, or two keys in front
  expectRefused("time,x,x,y,z,qx,qy,qz,qw\n0.5,4,4,5,6,0,0,0,1\n", {"columns 2 and 3"});
  expectRefused("time x y z qx qy qz qw\n", {"only a header"});
}

TEST(PoseKinds, AreReadAsStated) {
  expectQuarterTurn(parse("0.5 4 5 6 0 0 90\n", PoseFormat::XyzRpyDegrees));
  expectQuarterTurn(parse("4 5 6 0 0 1.570796\n", PoseFormat::XyzRpyRadians));
  expectQuarterTurn(parse("stamp,x,y,z,roll,pitch,yaw\n0.5,4,5,6,0,0,90\n", PoseFormat::XyzRpyDegrees));
  expectQuarterTurn(parse("500 4 5 6 0.70711 0 0 0.70711\n", PoseFormat::EuRoc));
  const PoseFile named = parse("9 0.70711 0 0 0.70711 4 5 6 0.5\n", PoseFormat::Table, "skip qw qx qy qz x y z time");
  expectQuarterTurn(named);
  EXPECT_EQ(named.entries[0].time, std::chrono::milliseconds(500));
  EXPECT_THROW(parse("0.5 4 5 6 0 0 90\n", PoseFormat::Kitti), FileError);
  EXPECT_THROW(parse("0.5 4 5 6 0 0 0 1\n", PoseFormat::Table, "time x y z"), FileError);
}

TEST(PoseKinds, AppliesRollThenPitchThenYaw) {  // roll 90: z to -y; pitch 90: then unchanged; yaw 90: -y to x
  const PoseFile file = parse("0 0 0 90 90 90\n", PoseFormat::XyzRpyDegrees);
  EXPECT_NEAR((file.entries[0].pose->rotation * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 0.0,
              1e-12);
}

TEST(Extrinsics, AreReadFromEveryUsualFile) {
  const TemporaryDirectory directory;
  for (const std::string& text :
       {kQuaternion, withCommas(kQuaternion), kMatrix, std::string("0 -1 0 4\n1 0 0 5\n0 0 1 6\n0 0 0 1\n"),
        std::string(
            "# lidar\nsensor_type: lidar\nT_BS:\n  cols: 4\n  rows: 4\n  data: [0, -1, 0, 4,\n    1, 0, 0, 5,\n    "
            "0, 0, 1, 6, 0, 0, 0, 1]\nrate_hz: 10\n")}) {
    const Extrinsic extrinsic = readExtrinsic(directory.write("extrinsic.txt", text));
    EXPECT_EQ(extrinsic.pose.translation, Eigen::Vector3d(4, 5, 6));
    EXPECT_NEAR(extrinsic.pose.rotation.z(), std::sqrt(0.5), 1e-5);
    EXPECT_FALSE(extrinsic.turns_map);
  }
  EXPECT_TRUE(readExtrinsic(directory.write("calib.txt", "P0: 1 2 3\nTr: " + kMatrix + "\n")).turns_map);
  EXPECT_TRUE(readExtrinsic(directory.write("calib.txt", "P0 1 2 3\nTr " + kMatrix + "\n")).turns_map);
  for (const char* const text : {"", "1 2 3", "P0: 1 2 3\n", "Tr 1 2 3\n", "R: 1 0 0\nT: 1 2 3\n", "Tr: 1 2 3\n",
                                 "T_BS:\n data: [1, 2]\n", "1 2 3 0 0 0 2\n"})
    EXPECT_THROW(readExtrinsic(directory.write("bad.txt", text)), FileError) << text;
}

TEST(Extrinsics, AreReadFromTheRawDataOfKitti) {
  const TemporaryDirectory directory;
  const std::string text = "calib_time: 09-Jan-2012 13:57:47\nR: 0 -1 0 1 0 0 0 0 1\nT: 4 5 6\ndelta_f: 0 0\n";
  const Extrinsic camera = readExtrinsic(directory.write("calib_velo_to_cam.txt", text));
  EXPECT_EQ(camera.pose.translation, Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(camera.turns_map);
  const Extrinsic imu = readExtrinsic(directory.write("calib_imu_to_velo.txt", text));  // of the IMU in the lidar
  EXPECT_NEAR((imu.pose.translation - Eigen::Vector3d(-5, 4, -6)).norm(), 0.0, 1e-12);
  EXPECT_FALSE(imu.turns_map);
  EXPECT_FALSE(readExtrinsic(directory.write("other.txt", text)).turns_map);
}

}  // namespace
}  // namespace gaussmap
