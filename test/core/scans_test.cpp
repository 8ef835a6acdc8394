// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/scans.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "gaussmap/core/error.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "gaussmap/sensor/projection.h"
#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"
#include "map/random_clouds.h"

namespace gaussmap {
namespace {

Pose somePose() {
  return normalised({{10, -20, 3}, {0.3, -0.5, 0.7, 0.2}});
}

TEST(ReadScan, KeepsAllPointsInTheirOrder) {
  const test::TemporaryDirectory directory;
  std::vector<Vector<3>> points = test::randomCloud<3>(3000, 1);  // several blocks
  points[700] = Vector<3>::Constant(std::numeric_limits<double>::quiet_NaN());
  points[701] = Vector<3>::Zero();
  const auto path = directory.path() / "scan.pcd";
  writePcd(path, points, PcdPrecision::Double);
  const Scan scan = FileScans({{path, somePose()}}).read(0);
  ASSERT_EQ(scan.points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) ASSERT_TRUE(i == 700 || scan.points[i] == points[i]);
  EXPECT_FALSE(isReturn(scan.points[700]));
  EXPECT_FALSE(isReturn(scan.points[701]));
  EXPECT_TRUE(isReturn(scan.points[702]));
  EXPECT_EQ(scan.columns, 0);
  EXPECT_EQ(scan.pose.translation, somePose().translation);
}

TEST(ReadScan, MovesPointsOfTheMapIntoTheSensorsFrame) {
  const test::TemporaryDirectory directory;
  const Pose pose = somePose();
  const std::vector<Vector<3>> in_sensor = test::randomCloud<3>(600, 2);
  std::vector<Vector<3>> in_map;
  for (const Vector<3>& point : in_sensor) in_map.push_back(pose * point);
  in_map.push_back(pose.translation);  // the sensor's own place
  const auto path = directory.path() / "scan.pcd";
  writePcd(path, in_map, PcdPrecision::Double);
  const Scan scan = FileScans({{path, pose}}, ScanFrame::Map).read(0);
  for (std::size_t i = 0; i < in_sensor.size(); ++i) ASSERT_LT((scan.points[i] - in_sensor[i]).norm(), 1e-13);
  EXPECT_FALSE(isReturn(scan.points.back()));
}

TEST(ReadScan, KnowsTheRowsOfAnOrganisedCloud) {
  const test::TemporaryDirectory directory;
  const std::vector<float> numbers(3 * 24, 1.5f);
  const std::size_t stride = 3 * sizeof(float);
  const std::vector<PcdOutput> fields = {pcdOutput("x", &numbers[0], 1, stride), pcdOutput("y", &numbers[1], 1, stride),
                                         pcdOutput("z", &numbers[2], 1, stride)};
  const auto path = directory.path() / "scan.pcd";
  writePcd(path, 24, fields, std::nullopt, 8);
  EXPECT_EQ(FileScans({{path, {}}}).read(0).columns, 8);
  EXPECT_EQ(FileScans({{path, {}}}).read(0).points.size(), 24u);
}

TEST(ReadScan, TakesAScanWithoutPointsAndRefusesAMissingFile) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "scan.pcd";
  writePcd(path, std::vector<Vector<3>>{});
  EXPECT_TRUE(FileScans({{path, {}}}).read(0).points.empty());
  EXPECT_THROW(FileScans({{directory.path() / "none.pcd", {}}}).read(0), FileError);
}

TEST(MemoryScansTest, GiveTheSameSumsAsTheSamePointsInFiles) {
  const test::TemporaryDirectory directory;
  MemoryScans in_memory;
  std::vector<FileScan> in_files;
  for (std::uint64_t i = 0; i < 3; ++i) {
    const std::vector<Vector<3>> points = test::randomCloud<3>(2000, 10 + i);
    Pose pose = somePose();
    pose.translation.x() += double(i);
    in_memory.add({points, pose, 0, 0.5 * double(i)});
    in_files.push_back({directory.path() / (std::to_string(i) + ".pcd"), pose});
    writePcd(in_files.back().path, points, PcdPrecision::Double);
  }
  const AccumulatedScans a = accumulateScans(in_memory, {}), b = accumulateScans(FileScans(in_files), {});
  ASSERT_EQ(a.moments.size(), b.moments.size());
  for (std::size_t i = 0; i < a.moments.size(); ++i) ASSERT_EQ(*b.moments.find(a.moments[i].key), a.moments[i].moments);
  EXPECT_EQ(in_memory.info(2).name, "scan 2");
  EXPECT_EQ(in_memory.info(2).time, 1.0);
  EXPECT_THROW(in_memory.info(3), std::out_of_range);
  EXPECT_THROW(in_memory.open(3), std::out_of_range);
}

TEST(MemoryScansTest, RefuseAPoseThatIsNoRotation) {
  MemoryScans scans;
  Pose pose;
  pose.rotation = {2, 0, 0, 0};
  EXPECT_THROW(scans.add({{}, pose}), std::invalid_argument);
  EXPECT_EQ(scans.size(), 0u);
}

TEST(MemoryScansTest, TakeFloatsOfOtherRecords) {
  const float records[] = {1, 2, 3, 99, 4, 5, 6, 99};
  MemoryScans scans;
  scans.add(PointsView{records, 2, 4}, somePose());
  EXPECT_EQ(scans.read(0).points, (std::vector<Eigen::Vector3d>{{1, 2, 3}, {4, 5, 6}}));
}

TEST(FileScansTest, OpenEachFileOnce) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "scan.pcd";
  writePcd(path, test::randomCloud<3>(1000, 20), PcdPrecision::Double);
  const FileScans scans({{path, {}}});
  const Scan before = scans.read(0);
  std::filesystem::remove(path);  // what is open stays readable
  EXPECT_EQ(scans.read(0).points, before.points);
  EXPECT_THROW(scans.open(1), std::out_of_range);
}

TEST(FileScansTest, KeepPointsForTheNextOpenOnlyIfAllowed) {
  // The program overwrites the file. A reader that kept its points does not see that.
  const test::TemporaryDirectory directory;
  const std::string text = test::xyzHeader(1, "ascii");
  const std::filesystem::path path = directory.write("scan.pcd", text + "1 2 3\n");
  const auto overwrite = [&](const std::string& point) {
    std::fstream(path, std::ios::in | std::ios::out | std::ios::binary).seekp(std::streamoff(text.size())) << point;
  };
  const auto xOf = [](const ScanReader& reader) {
    PointBlock<3> block;
    reader.read(0, block);
    return block.coordinate[0][0];
  };
  FileScans scans({{path, {}}});
  EXPECT_EQ(xOf(*scans.open(0)), 1.0);
  overwrite("4");
  EXPECT_EQ(xOf(*scans.open(0)), 4.0);  // nothing is kept
  scans.keepForNextOpen(1);
  EXPECT_EQ(xOf(*scans.open(0)), 4.0);
  overwrite("5");
  EXPECT_EQ(xOf(*scans.open(0)), 5.0);  // the points take more than one byte
  scans.keepForNextOpen(1000);
  EXPECT_EQ(xOf(*scans.open(0)), 5.0);
  scans.keepForNextOpen(0);
  overwrite("6");
  EXPECT_EQ(xOf(*scans.open(0)), 5.0);  // kept
  EXPECT_EQ(xOf(*scans.open(0)), 6.0);  // only once
}

TEST(FileScansTest, CarryTheValuesOfTheirPoints) {
  const test::TemporaryDirectory directory;
  const auto path = directory.path() / "scan.pcd";
  const std::vector<float> xyz = {1, 2, 3, 4, 5, 6}, colour = {7, 8, 9, 10};
  const std::vector<std::uint16_t> rings = {11, 12};
  const std::size_t stride = 3 * sizeof(float);
  writePcd(path, 2,
           {pcdOutput("x", &xyz[0], 1, stride), pcdOutput("y", &xyz[1], 1, stride), pcdOutput("z", &xyz[2], 1, stride),
            pcdOutput("uv", colour.data(), 2), pcdOutput("ring", rings.data())});
  const FileScans scans({{path, {}}});
  const std::unique_ptr<ScanReader> reader = scans.open(0);
  EXPECT_EQ(reader->valueNames(), (std::vector<std::string>{"uv[0]", "uv[1]", "ring"}));
  EXPECT_EQ(reader->values("uv[1]"), (std::vector<double>{8, 10}));
  EXPECT_EQ(reader->values("ring"), (std::vector<double>{11, 12}));
  EXPECT_THROW(reader->values("intensity"), std::out_of_range);
}

TEST(PointFilter, CountsAPointAtTheSensorAlikeInAllFramesAndModes) {
  Pose pose = somePose();
  const std::vector<Eigen::Vector3d> in_sensor = {{0, 0, 0}, {1, 2, 3}, {30, 0, 0}};
  std::vector<Eigen::Vector3d> in_map;
  for (const Eigen::Vector3d& point : in_sensor) in_map.push_back(pose * point);
  for (const ScanFrame frame : {ScanFrame::Sensor, ScanFrame::Map}) {
    const MemoryScans scans({{frame == ScanFrame::Map ? in_map : in_sensor, pose}}, frame);
    const PointCounts at_once = accumulateScans(scans, {0.1, 10.0}).counts;
    OnlineOptions options;
    options.max_range = 10.0;
    const PointCounts on_line = OnlineMapper<3>(options).add(scans.read(0)).points;
    for (const PointCounts& counts : {at_once, on_line}) {
      EXPECT_EQ(counts.accepted, 1);
      EXPECT_EQ(counts.at_sensor, 1);
      EXPECT_EQ(counts.beyond_range, 1);
    }
  }
}

}  // namespace
}  // namespace gaussmap
