// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/float_records.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "io/files/file_contents.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/text/text_data.h"

namespace gaussmap::detail {
namespace {

using test::namesIn;
using test::numbersOf;
using test::rowsOf;
using test::textData;
using test::textOf;

std::string bytesOfFloats(const std::vector<float>& values) {
  std::string bytes(values.size() * sizeof(float), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

class FloatRecordFiles : public testing::Test {
 protected:
  std::unique_ptr<ScanFile> open(const std::string& bytes, const std::string& fields = "",
                                 const std::string& name = "scan.bin") const {
    return openFloatRecords(directory_.write(name, bytes), {fields});
  }
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces, const std::string& fields = "",
                     const std::string& name = "scan.bin") const {
    const std::filesystem::path path = directory_.write(name, bytes);
    test::expectComplaint(test::complaintOf([&] { rowsOf(*openFloatRecords(path, {fields})); }), path, pieces);
  }
  test::TemporaryDirectory directory_;
};

TEST_F(FloatRecordFiles, EqualWhatNumpyReads) {
  const std::vector<std::vector<std::string>> files = {
      {"kitti.bin", "", "intensity", "raw records of KITTI, x:f32 y:f32 z:f32 intensity:f32"},
      {"nuscenes.pcd.bin", "", "intensity ring", "raw records of nuScenes, x:f32 y:f32 z:f32 intensity:f32 ring:f32"},
      {"mixed.bin", "x y z:f64 ring:u16 -:u8 time:u32:ns label:i32 a:i8 b:i16", "ring time label a b",
       "raw records, x:f32 y:f32 z:f64 ring:u16 -:u8 time:u32 label:i32 a:i8 b:i16"}};
  for (const std::vector<std::string>& about : files) {
    const std::unique_ptr<ScanFile> file = openFloatRecords(textData(about[0]), {about[1]});
    EXPECT_EQ(textOf(rowsOf(*file)), textOf(numbersOf(textData(about[0] + ".expected")))) << about[0];
    EXPECT_EQ(namesIn(*file), about[2]);
    EXPECT_EQ(file->kind(), about[3]);
    EXPECT_EQ(file->warnings(), std::vector<std::string>()) << about[0];
    EXPECT_EQ(file->info(0).points, 40u);
  }
}

TEST_F(FloatRecordFiles, TheContentDecidesIfTheSizeFitsBoth) {
  std::vector<float> kitti, nuscenes;
  Random random(5);
  const auto number = [&random](int range) {
    return static_cast<float>(random.below(2000)) / 1000.0f * static_cast<float>(range);
  };
  for (int i = 0; i < 400; ++i) {
    for (std::vector<float>* const records : {&kitti, &nuscenes})
      records->insert(records->end(), {number(50) - 50.0f, number(50) - 50.0f, number(2) - 2.0f, number(1) / 2.0f});
    nuscenes.push_back(static_cast<float>(i % 32));
  }
  EXPECT_EQ(open(bytesOfFloats(kitti))->info(0).points, 400u);     // 6400 bytes
  EXPECT_EQ(open(bytesOfFloats(nuscenes))->info(0).points, 400u);  // 8000 bytes
  EXPECT_EQ(namesIn(*open(bytesOfFloats(nuscenes))), "intensity ring");
}

TEST_F(FloatRecordFiles, WhatFitsBothOrNeitherIsRefused) {
  const std::vector<float> ones(20, 1.0f);
  expectRefused(bytesOfFloats(ones), {"--fields \"x y z intensity\" or --fields \"x y z intensity ring\""});
  EXPECT_EQ(open(bytesOfFloats(ones), "", "scan.pcd.bin")->info(0).points, 4u);  // the name decides
  expectRefused(bytesOfFloats(std::vector<float>(20, 0.0f)), {"all numbers would be 0", "--fields"});
  expectRefused(bytesOfFloats({1, 2, 3, -5}), {"16 bytes", "intensity would be -5", "not a multiple of 20"});
  expectRefused(bytesOfFloats({1, 2, 3, 0.5f, 3.5f}), {"ring would be 3.5"});
  expectRefused(bytesOfFloats({1, 2e4f, 3, 0.5f}), {"y would be 2e+04"});
  expectRefused(bytesOfFloats({1, std::numeric_limits<float>::quiet_NaN(), 3, 0.5f}), {"y would be nan"});
  expectRefused(bytesOfFloats({1, 1e-40f, 3, 0.5f}), {"y would be 1e-40"});
  std::vector<float> longer;  // x y z 1, then four values
  for (int i = 0; i < 200; ++i)
    for (const float value : {float(i % 17), float(i % 13), 1.5f, 1.0f, 0.5f, float(i % 3), float(i % 5), 0.0f})
      longer.push_back(value);
  expectRefused(bytesOfFloats(longer), {"every second point would be of another kind"});
  expectRefused("\x01\x02\x03", {"3 bytes"});
  expectRefused(bytesOfFloats({1, 2, 3, 1.5f, 4, 5, 6, 2.5f}), {"intensity would be 1.5"});  // 3 floats per record
  expectRefused(bytesOfFloats({1, 2, 3, 1, 0.5f, 0, 0, 0, 4, 5, 6, 1, 0.25f, 0, 0, 0}),
                {"y and z of many points would be 0"});  // 8 floats per record, as in PCL
  Random random(7);
  std::string noise(8000, '\0');
  for (char& byte : noise) byte = static_cast<char>(random.below(256));
  expectRefused(noise, {"--fields"});
}

TEST_F(FloatRecordFiles, TheUserCanNameTheFields) {
  EXPECT_EQ(textOf(rowsOf(*open(bytesOfFloats({1, 2, 3, 4, 5, 6}), "x y z i r t"))), "1 2 3 4 5 6\n");
  EXPECT_EQ(textOf(rowsOf(*open(bytesOfFloats({9, 1, 2, 3}), "- x y z"))), "1 2 3\n");
  EXPECT_EQ(textOf(rowsOf(*open(std::string("\xE8\x03\0\0\0\0\0\0\xFF\xFF\xFF\xFF\x01\x02\x03", 15),
                                "x:i32:mm y:i32:mm z:i32:mm r:u8 g:u8 b:u8"))),
            "1 0 -0.001 66051\n");
  std::string packed = bytesOfFloats({1, 2, 3});
  packed += std::string("\x03\x02\x01\xFF", 4);
  EXPECT_EQ(textOf(rowsOf(*open(packed, "x y z rgb"))), "1 2 3 66051\n");  // the bits of the float
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(textOf(rowsOf(*open(bytesOfFloats({1, 2, nan}), "x y z"))), "1 2 nan\n");
}

TEST_F(FloatRecordFiles, FieldsThatDoNotFitAreRefusedOrSaid) {
  expectRefused(bytesOfFloats({1, 2, 3, 4}), {"16 bytes are not a multiple of 12", "x:f32 y:f32 z:f32"}, "x y z");
  EXPECT_EQ(open(bytesOfFloats({1e20f, 2, 3}), "x y z")->warnings().size(), 1u);
  std::vector<float> kitti;
  for (int i = 0; i < 20; ++i) kitti.insert(kitti.end(), {-1.5f, 2.5f, 3.5f, 0.25f});
  ASSERT_EQ(open(bytesOfFloats(kitti), "x y z i t")->warnings().size(), 1u);
  EXPECT_NE(open(bytesOfFloats(kitti), "x y z i t")->warnings()[0].find("looks like --fields \"x y z intensity\""),
            std::string::npos);
  const std::filesystem::path path = directory_.write("scan.bin", bytesOfFloats(kitti));
  for (const char* const fields : {"x y", "x:f16 y z", "x:i32 y z", "x:f32:f64 y z", "x y z x", "x y z time:mm"})
    EXPECT_THROW(openFloatRecords(path, {fields}), std::invalid_argument) << fields;
}

TEST_F(FloatRecordFiles, OtherKindsOfFilesAreRefused) {
  const std::string rest(60, '\x01');
  expectRefused("", {"the file is empty"});
  expectRefused("ply\n" + rest, {"is a PLY file"});
  expectRefused("# .PCD v0.7" + rest, {"is a PCD file"}, "x y z");
  expectRefused("LASF" + rest, {"is a LAS or LAZ file"});
  expectRefused("ASTM-E57" + rest, {"is an E57 file"});
  expectRefused("\x89MCAP" + rest, {"is an MCAP file"});
  expectRefused("#ROSBAG V2.0\n" + rest, {"is a ROS bag"});
  expectRefused("SQLite format 3" + rest, {"is an SQLite file"});
  expectRefused("\x1F\x8B" + rest, {"gunzip"});
  expectRefused("1.5 2.5 3.5 0.25\n1.5 2.5 3.5 0.25\n", {"is a text"});
  expectRefused("1.5 2.5 3.5 0.25\n1.5 2.5 3.5 0.25\n", {"is a text"}, "x y z -");
}

TEST_F(FloatRecordFiles, MutationsAreReadOrRefused) {
  const std::vector<std::string> good = {test::contentsOf(textData("kitti.bin")),
                                         test::contentsOf(textData("nuscenes.pcd.bin"))};
  test::expectMutationsReadOrRefused(good, [&](const std::string& bytes) { rowsOf(*open(bytes)); });
}

TEST_F(FloatRecordFiles, AFileThatIsCutOffWhileItIsReadIsNoticed) {
  const std::unique_ptr<ScanFile> file = openFloatRecords(directory_.write("scan.bin", bytesOfFloats({1, 2, 3, 0.5f})));
  const std::unique_ptr<ScanReader> reader = file->open(0);
  std::filesystem::resize_file(directory_.path() / "scan.bin", 8);
  EXPECT_NE(test::complaintOf([&] { reader->requireWhole(); }).find("was cut off"), std::string::npos);
}

}  // namespace
}  // namespace gaussmap::detail
