// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply/ply_cloud.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "io/files/temporary_directory.h"
#include "io/formats/scan_values.h"
#include "io/pcd/pcd_bytes.h"

namespace gaussmap {
namespace {

using detail::openPlyCloud;
using test::bytesOf;
using test::columnOf;
using Column = std::vector<double>;

const std::filesystem::path kPlyFolder = std::filesystem::path(GAUSSMAP_TEST_DATA) / "formats" / "ply";

/// Returns a number with its bytes in reverse order.
template <typename T>
std::string bigBytesOf(T value) {
  std::string bytes = bytesOf(value);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string headerOf(const std::string& format, const std::string& lines) {
  return "ply\nformat " + format + " 1.0\n" + lines + "end_header\n";
}
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

class PlyClouds : public testing::Test {
 protected:
  std::unique_ptr<detail::ScanFile> open(const std::string& bytes) const {
    return openPlyCloud(directory_.write("cloud.ply", bytes));
  }
  std::unique_ptr<ScanReader> read(const std::string& bytes) const { return open(bytes)->open(0); }
  std::string warningsOf(const std::string& bytes) const {
    std::string text;
    for (const std::string& warning : open(bytes)->warnings()) text += warning + "\n";
    return text;
  }
  test::TemporaryDirectory directory_;
};

TEST_F(PlyClouds, FilesOfOtherWritersHaveTheValuesOfAnotherReader) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kPlyFolder)) {
    if (entry.path().extension() != ".ply") continue;
    const auto file = openPlyCloud(entry.path());
    test::expectValuesOf(std::filesystem::path(entry.path()).replace_extension(".txt"), *file->open(0));
    for (const std::string& warning : file->warnings())
      EXPECT_TRUE(warning.find("the file is a mesh") == 0 || warning.find("the pose in the element camera") == 0)
          << entry.path() << warning;
    ++files;
  }
  EXPECT_EQ(files, 8);
}

TEST_F(PlyClouds, TheFileIsOneScanInTheSensorFrame) {
  const auto file = openPlyCloud(kPlyFolder / "pcl_binary.ply");
  EXPECT_EQ(file->kind(), "PLY binary_little_endian");
  EXPECT_EQ(openPlyCloud(kPlyFolder / "vtk_big.ply")->kind(), "PLY binary_big_endian");
  EXPECT_EQ(openPlyCloud(kPlyFolder / "vtk_ascii.ply")->kind(), "PLY ascii");
  EXPECT_EQ(file->size(), 1u);
  EXPECT_EQ(file->info(0).points, 24u);
  EXPECT_FALSE(file->inMapFrame());
  EXPECT_EQ(file->coordinateSystem(), "");
}

TEST_F(PlyClouds, AllTypesInAllEncodingsAreRead) {
  const std::string lines =
      "element vertex 2\nproperty int8 a\nproperty uchar b\nproperty int16 c\nproperty ushort d\nproperty double z\n"
      "property int32 y\nproperty uint e\nproperty float32 x\nproperty float64 time\n";
  std::string little = headerOf("binary_little_endian", lines), big = headerOf("binary_big_endian", lines);
  const auto add = [&](auto value) {
    little += bytesOf(value);
    big += bigBytesOf(value);
  };
  for (int i = 0; i < 2; ++i) {
    add(static_cast<std::int8_t>(i - 128));
    add(static_cast<std::uint8_t>(255 - i));
    add(static_cast<std::int16_t>(i - 32768));
    add(static_cast<std::uint16_t>(65535 - i));
    add(0.1 + i);
    add(std::int32_t{-2147483647 - 1 + i});
    add(4294967295u - static_cast<std::uint32_t>(i));
    add(0.1f + static_cast<float>(i));
    add(1.7e9 + 1e-6 * i);
  }
  const std::string ascii = headerOf("ascii", lines) +
                            "-128 255 -32768 65535 0.1 -2147483648 4294967295 0.1 1700000000\r\n"
                            "\n  -127 254\t-32767 65534 1.1 -2147483647 4294967294 1.1 1700000000.000001\n\n";
  for (const std::string& bytes : {little, big, ascii}) {
    const auto reader = read(bytes);
    ASSERT_EQ(reader->size(), 2u);
    EXPECT_EQ(reader->valueNames(), (std::vector<std::string>{"a", "b", "c", "d", "e", "time"}));
    EXPECT_EQ(columnOf(*reader, "x"), (Column{0.1f, 1.1f}));
    EXPECT_EQ(columnOf(*reader, "y"), (Column{-2147483648.0, -2147483647.0}));
    EXPECT_EQ(columnOf(*reader, "z"), (Column{0.1, 1.1}));
    EXPECT_EQ(reader->values("a"), (Column{-128, -127}));
    EXPECT_EQ(reader->values("b"), (Column{255, 254}));
    EXPECT_EQ(reader->values("c"), (Column{-32768, -32767}));
    EXPECT_EQ(reader->values("d"), (Column{65535, 65534}));
    EXPECT_EQ(reader->values("e"), (Column{4294967295.0, 4294967294.0}));
    EXPECT_EQ(reader->values("time"), (Column{1.7e9, 1.7e9 + 1e-6}));
    EXPECT_THROW(reader->values("x"), std::out_of_range);
  }
}

TEST_F(PlyClouds, ElementsBeforeAndBehindAreSkipped) {
  const std::string lines =
      "element tag 2\nproperty ushort id\nelement face 2\nproperty list uchar short corners\n"
      "property list int double more\nelement vertex 2\n" +
      kXyz + "element edge 1\nproperty list uchar int vertices\n";
  std::string little = headerOf("binary_little_endian", lines), big = headerOf("binary_big_endian", lines);
  const auto add = [&](auto value) {
    little += bytesOf(value);
    big += bigBytesOf(value);
  };
  for (const std::uint16_t tag : {std::uint16_t{7}, std::uint16_t{8}}) add(tag);
  add(std::uint8_t{3});
  for (const std::int16_t corner : {std::int16_t{0}, std::int16_t{1}, std::int16_t{2}}) add(corner);
  add(std::int32_t{1});
  add(2.5);
  add(std::uint8_t{0});
  add(std::int32_t{0});
  for (int i = 1; i <= 6; ++i) add(static_cast<float>(i));
  add(std::uint8_t{200});  // the elements behind are not read
  const std::string ascii = headerOf("ascii", lines) + "7\n8\n3 0 1 2 1 2.5\n0 0\n1 2 3\n4 5 6\n200\n";
  for (const std::string& bytes : {little, big, ascii}) {
    const auto reader = read(bytes);
    EXPECT_EQ(test::coordinatesOf(*reader), (std::vector<Column>{{1, 4}, {2, 5}, {3, 6}}));
    EXPECT_TRUE(reader->valueNames().empty());
    EXPECT_EQ(warningsOf(bytes),
              "the file is a mesh with 2 faces: its vertices are used as points, and the faces are ignored\n");
  }
}

TEST_F(PlyClouds, VerticesCanHaveLists) {
  const std::string lines =
      "element vertex 2\nproperty float z\nproperty list uchar float echoes\nproperty float x\n"
      "property uchar label\nproperty float y\n";
  std::string little = headerOf("binary_little_endian", lines), big = headerOf("binary_big_endian", lines);
  const auto add = [&](auto value) {
    little += bytesOf(value);
    big += bigBytesOf(value);
  };
  for (int i = 0; i < 2; ++i) {
    add(3.0f + static_cast<float>(i));
    add(static_cast<std::uint8_t>(i));
    if (i == 1) add(9.0f);
    add(1.0f);
    add(static_cast<std::uint8_t>(5 + i));
    add(2.0f);
  }
  for (const std::string& bytes : {little, big, headerOf("ascii", lines) + "3 0 1 5 2\n4 1 9 1 6 2\n"}) {
    const auto reader = read(bytes);
    EXPECT_EQ(test::coordinatesOf(*reader), (std::vector<Column>{{1, 1}, {2, 2}, {3, 4}}));
    EXPECT_EQ(reader->valueNames(), (std::vector<std::string>{"label"}));
    EXPECT_EQ(reader->values("label"), (Column{5, 6}));
  }
}

TEST_F(PlyClouds, NamesOfValuesAreThoseOfPcl) {
  const auto reader = read(headerOf("ascii", "element vertex 1\n" + kXyz +
                                                 "property float scalar_Intensity\nproperty float scalar_Ring\n"
                                                 "property double scalar_Gps_Time\nproperty float scalar_Echo_Width\n"
                                                 "property float intensity\nproperty uchar alpha\nproperty float nx\n"
                                                 "property float scalar_\n") +
                           "1 2 3 4 5 6 7 8 9 10 11\n");
  EXPECT_EQ(reader->valueNames(),
            (std::vector<std::string>{"intensity", "ring", "time", "Echo_Width", "alpha", "nx", "scalar_"}));
  EXPECT_EQ(reader->values("intensity"), (Column{4}));
  EXPECT_EQ(reader->values("time"), (Column{6}));
}

TEST_F(PlyClouds, ColoursArePackedAsInPcl) {
  const auto colours = [&](const std::string& type, const std::string& names, const std::string& values) {
    std::string lines = "element vertex 2\n" + kXyz;
    for (const char name : names)
      lines += "property " + type + (name == 'r' ? " red\n" : name == 'g' ? " green\n" : " blue\n");
    return read(headerOf("ascii", lines) + "0 0 0 " + values + "\n0 0 0 0 0 0\n")->values("rgb");
  };
  EXPECT_EQ(colours("uchar", "rgb", "255 128 1"), (Column{0xFF8001, 0}));
  EXPECT_EQ(colours("uchar", "brg", "1 255 128"), (Column{0xFF8001, 0}));
  EXPECT_EQ(colours("ushort", "rgb", "65535 32768 256"), (Column{0xFF8001, 0}));
  EXPECT_EQ(colours("ushort", "rgb", "255 128 1"), (Column{0xFF8001, 0}));
  EXPECT_EQ(colours("float", "rgb", "1.0 0.5 0.004"), (Column{0xFF8001, 0}));
  EXPECT_EQ(colours("float", "rgb", "255 nan -3"), (Column{0xFF0000, 0}));
  EXPECT_EQ(colours("float", "rgb", "inf 1e30 2"), (Column{0xFFFF02, 0}));
}

TEST_F(PlyClouds, UpperCaseCoordinatesCountIfThereAreNoOthers) {
  const std::string upper = "property float X\nproperty float Y\nproperty float Z\n";
  EXPECT_EQ(columnOf(*read(headerOf("ascii", "element vertex 1\n" + upper) + "1 2 3\n"), "z"), (Column{3}));
  const auto both = read(headerOf("ascii", "element vertex 1\n" + upper + kXyz) + "1 2 3 4 5 6\n");
  EXPECT_EQ(columnOf(*both, "z"), (Column{6}));
  EXPECT_EQ(both->values("X"), (Column{1}));
}

TEST_F(PlyClouds, NumbersThatAreNotFiniteAreKept) {
  const auto reader = read(headerOf("ascii", "element vertex 2\n" + kXyz) + "nan -nan inf\n1e300 1e-300 +5\n");
  const auto axes = test::coordinatesOf(*reader);
  EXPECT_TRUE(std::isnan(axes[0][0]) && std::isnan(axes[1][0]));
  EXPECT_EQ(axes[2], (Column{std::numeric_limits<double>::infinity(), 5}));
  EXPECT_EQ(axes[0][1], 1e300);
}

TEST_F(PlyClouds, HeadersWithCarriageReturnsAreRead) {
  std::string bytes =
      "ply\r\nformat binary_little_endian 1.0\r\ncomment a b\r\nobj_info c\r\nelement vertex 1\r\n"
      "property float x\r\nproperty float y\r\nproperty float z\r\nend_header\r\n";
  for (int i = 1; i <= 3; ++i) bytes += bytesOf(static_cast<float>(i));
  EXPECT_EQ(test::coordinatesOf(*read(bytes)), (std::vector<Column>{{1}, {2}, {3}}));
}

TEST_F(PlyClouds, AReaderOutlivesItsFileAndReadsAnyBlock) {
  std::string ascii = headerOf("ascii", "element vertex 1500\n" + kXyz);
  std::string binary = headerOf("binary_little_endian", "element vertex 1500\n" + kXyz);
  for (int i = 0; i < 1500; ++i) {
    ascii += std::to_string(i) + " " + std::to_string(-i) + " 7\n";
    for (const int value : {i, -i, 7}) binary += bytesOf(static_cast<float>(value));
  }
  for (const std::string& bytes : {ascii, binary}) {
    const auto reader = read(bytes);
    PointBlock<3> block;
    reader->read(1400, block);
    ASSERT_EQ(block.size, 100u);
    EXPECT_EQ(block.coordinate[1][99], -1499);
    reader->read(700, block);
    EXPECT_EQ(block.size, PointBlock<3>::kCapacity);
    EXPECT_EQ(block.coordinate[0][0], 700);
    reader->read(1500, block);
    EXPECT_EQ(block.size, 0u);
    EXPECT_NO_THROW(reader->requireWhole());
  }
}

TEST_F(PlyClouds, DoubtfulContentsAreWarnings) {
  const std::string whole = "element vertex 1\nproperty int x\nproperty int y\nproperty int z\n";
  EXPECT_NE(warningsOf(headerOf("ascii", whole) + "1 2 3\n").find("x is a whole number"), std::string::npos);
  const std::string binary = headerOf("binary_little_endian", "element vertex 1\n" + kXyz);
  EXPECT_EQ(warningsOf(binary + std::string(12 + 11, 'a')), "");
  EXPECT_NE(warningsOf(binary + std::string(12 + 25, 'a')).find("1 vertices, but there is room for 3"),
            std::string::npos);
  const std::string splats = "element vertex 0\n" + kXyz + "property float scale_0\nproperty float rot_0\n";
  EXPECT_NE(warningsOf(headerOf("ascii", splats)).find("Gaussians"), std::string::npos);
}

TEST_F(PlyClouds, PlyIsRecognised) {
  EXPECT_TRUE(detail::isPly("ply\nformat"));
  EXPECT_TRUE(detail::isPly("ply\r\nformat"));
  EXPECT_TRUE(detail::isPly("ply"));
  EXPECT_FALSE(detail::isPly("plywood\n"));
  EXPECT_FALSE(detail::isPly("pl"));
  EXPECT_FALSE(detail::isPly("Ply\n"));
}

}  // namespace
}  // namespace gaussmap
