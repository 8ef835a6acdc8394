// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/formats/scan_values.h"
#include "io/pcd/pcd_bytes.h"
#include "io/ply/ply_cloud.h"

namespace gaussmap {
namespace {

using test::bytesOf;

const std::string kFloats = "property float x\nproperty float y\nproperty float z\n";
const std::string kAsciiHeader = "ply\nformat ascii 1.0\nelement vertex 2\n" + kFloats + "end_header\n";
const std::string kAscii = kAsciiHeader + "1 2 3\n4 5 6\n";

std::string binaryFile(const std::string& format) {
  std::string bytes = "ply\nformat " + format +
                      " 1.0\nelement face 2\nproperty list int uchar corners\nelement vertex 2\n" + kFloats +
                      "property list uchar ushort echoes\nproperty uchar red\nproperty uchar green\n"
                      "property uchar blue\nend_header\n";
  const bool is_big = format == "binary_big_endian";
  for (const unsigned length : {2u, 1u}) {
    const std::string bytes_of_length = bytesOf(is_big ? length << 24 : length);
    bytes += bytes_of_length + std::string(length, 'c');
  }
  for (int i = 0; i < 2; ++i) {
    for (int axis = 0; axis < 3; ++axis) bytes += bytesOf(static_cast<float>(axis));
    bytes += bytesOf(std::uint8_t{1}) + "ee" + "rgb";
  }
  return bytes;
}

class BadPlyClouds : public testing::Test {
 protected:
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces) const {
    const std::filesystem::path path = directory_.write("cloud.ply", bytes);
    test::expectComplaint(test::complaintOf([&] { test::readAll(*detail::openPlyCloud(path)); }), path, pieces);
  }
  void expectChangeRefused(std::string text, const std::string& part, const std::string& replacement,
                           const std::vector<std::string>& pieces) const {
    const std::size_t place = text.find(part);
    ASSERT_NE(place, std::string::npos) << part;
    expectRefused(text.replace(place, part.size(), replacement), pieces);
  }
  test::TemporaryDirectory directory_;
};

TEST_F(BadPlyClouds, VerticesWithoutCoordinatesAreRefused) {
  expectChangeRefused(kAscii, "element vertex", "element point", {"no element vertex"});
  expectChangeRefused(kAscii, "property float z", "property float w", {"line 3", "'vertex'", "'z'", "a map needs"});
  expectChangeRefused(kAscii, "property float z", "property list uchar float z", {"line 3", "'z'"});
  expectRefused("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n", {"'x'"});
  expectRefused("ply\nformat ascii 1.0\nelement tag 3\nelement vertex 0\n" + kFloats + "end_header\n",
                {"line 3", "'tag'", "no property"});
}

TEST_F(BadPlyClouds, NumbersThatLieAreRefusedBeforeMemoryIsTaken) {
  for (const std::string number : {"1000", "4000000000", "1000000000000000", "18446744073709551615"}) {
    expectChangeRefused(kAscii, "vertex 2", "vertex " + number, {"line 3", number, "do not fit"});
    for (const std::string format : {"binary_little_endian", "binary_big_endian"}) {
      expectChangeRefused(binaryFile(format), "vertex 2", "vertex " + number, {"line 5", number, "do not fit"});
      expectChangeRefused(binaryFile(format), "face 2", "face " + number, {"line 3", number, "do not fit"});
    }
  }
}

TEST_F(BadPlyClouds, EveryTruncationIsRefused) {
  for (const std::string format : {"binary_little_endian", "binary_big_endian"}) {
    const std::string good = binaryFile(format);
    for (std::size_t size = 0; size < good.size(); ++size) expectRefused(good.substr(0, size), {});
  }
  for (std::size_t size = 0; size + 2 < kAscii.size(); ++size) expectRefused(kAscii.substr(0, size), {});
}

TEST_F(BadPlyClouds, ListsThatDoNotFitAreRefused) {
  std::string bytes = binaryFile("binary_little_endian");
  const std::size_t faces = bytes.find("end_header\n") + 11;
  const auto changed = [&](std::size_t place, const std::string& piece) {
    return std::string(bytes).replace(place, piece.size(), piece);
  };
  expectRefused(changed(faces, bytesOf(-1)), {"byte ", "'face' 0", "a list of -1 entries"});
  expectRefused(changed(faces, bytesOf(2000000000)), {"'face' 0", "2000000000 entries does not fit"});
  expectRefused(changed(faces + 11 + 12, "\xFF"), {"'vertex' 0", "255 entries does not fit"});
}

TEST_F(BadPlyClouds, TextThatIsNotRightIsRefusedWithItsLine) {
  expectRefused(kAsciiHeader + "1 2 3\n4 5\n", {"line 9", "ends before 'z'"});
  expectRefused(kAsciiHeader + "1 2 3\n4 5 6 7\n", {"line 9", "more values than the 3 properties"});
  expectRefused(kAsciiHeader + "1 2 3\n4 5 6\n7 8 9\n", {"line 10", "more data than the 2 vertices"});
  expectRefused(kAsciiHeader + "1 2 3\n4,5 5 6\n", {"line 9", "'4,5' is not a number"});
  expectRefused(kAsciiHeader + "1 2 3\n\n\n4 5e 6\n", {"line 11", "'5e'"});
  expectRefused(kAsciiHeader + "1 2 3\n          ", {"the data end after 1 of 2"});
  const std::string lists =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int l\n" + kFloats + "end_header\n";
  expectRefused(lists + "18446744073709551615 1 2 3 4 5 6\n", {"line 9", "ends before 'l'"});
  expectRefused(lists + "-1 1 2 3 4 5 6\n", {"line 9", "'-1' is not the length of a list"});
}

TEST_F(BadPlyClouds, AHugeHeaderTakesLittleTime) {
  std::string header = "ply\nformat ascii 1.0\nelement vertex 0\n" + kFloats;
  for (int i = 0; i < 40000; ++i) header += "property char p" + std::to_string(i) + "\n";
  EXPECT_EQ(test::complaintOf([&] { detail::openPlyCloud(directory_.write("cloud.ply", header + "end_header\n")); }),
            "");
}

TEST_F(BadPlyClouds, DamagedFilesAreReadOrRefused) {
  test::expectMutationsReadOrRefused(
      {kAscii, binaryFile("binary_little_endian"), binaryFile("binary_big_endian")},
      [&](const std::string& bytes) { test::readAll(*detail::openPlyCloud(directory_.write("cloud.ply", bytes))); });
}

}  // namespace
}  // namespace gaussmap
