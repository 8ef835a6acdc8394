// SPDX-License-Identifier: BSD-3-Clause
// Values that doubles or floats cannot hold survive reading and writing.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"
#include "io/pcd/pcd_records.h"

namespace gaussmap::test {
using namespace detail;

namespace {

template <typename T>
T valueOf(const PcdRecords& records, std::size_t field, std::size_t point) {
  T value;
  std::memcpy(&value, records.bytes.data() + point * records.record_size + records.fields[field].offset, sizeof(T));
  return value;
}

class ExactPcd : public testing::Test {
 protected:
  PcdRecords read(const std::string& text) const { return readRecords(PcdReader(directory_.write("scan.pcd", text))); }
  PcdRecords copyOf(const PcdRecords& records) const {
    writePcd(directory_.path() / "copy.pcd", records);
    return readRecords(PcdReader(directory_.path() / "copy.pcd"));
  }

  TemporaryDirectory directory_;
};

TEST_F(ExactPcd, KeepsIntegersOf64BitsInEveryEncoding) {
  const std::uint64_t stamp = 1700000000123456789u;  // between two doubles, which are 256 apart here
  const std::int64_t negative = -9007199254740993;   // -2^53 - 1
  const std::string header =
      "FIELDS x y z t n\nSIZE 4 4 4 8 8\nTYPE F F F U I\nCOUNT 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ";
  const std::string bytes = bytesOf(1.0f) + bytesOf(2.0f) + bytesOf(3.0f) + bytesOf(stamp) + bytesOf(negative);
  for (const std::string& body : {std::string("ascii\n1 2 3 1700000000123456789 -9007199254740993\n"),
                                  "binary\n" + bytes, "binary_compressed\n" + compressedBody(bytes)}) {
    const PcdRecords records = copyOf(read(header + body));
    EXPECT_EQ(valueOf<std::uint64_t>(records, 3, 0), stamp);
    EXPECT_EQ(valueOf<std::int64_t>(records, 4, 0), negative);
  }
}

TEST_F(ExactPcd, RoundsWordsOfIntegerFieldsThatAreNotIntegers) {
  const PcdRecords records = read(
      "FIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F U\nPOINTS 5\nDATA ascii\n"
      "0 0 0 +18446744073709551615\n0 0 0 1.5e3\n0 0 0 -4\n0 0 0 nan\n0 0 0 1e30\n");
  const std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t expected[] = {most, 1500, 0, 0, most};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(valueOf<std::uint64_t>(records, 3, i), expected[i]) << i;
}

TEST_F(ExactPcd, RefusesWordsThatAreNoNumbers) {
  const std::string header = "FIELDS x y z t\nSIZE 4 4 4 8\nTYPE F F F U\nPOINTS 1\nDATA ascii\n";
  EXPECT_THROW(read(header + "0 0 0 12a\n"), FileError);
  EXPECT_THROW(read(header + "0 0 0 0x10\n"), FileError);
}

TEST_F(ExactPcd, MovesCoordinatesToDoublesIfFloatsWouldRoundThem) {
  const std::string text = "FIELDS id x y z t\nSIZE 2 4 4 4 8\nTYPE U F F F U\nPOINTS 1\nDATA ascii\n7 1 2 3 5\n";
  Pose far;
  far.translation = {500000.125, -4100000.25, 80.5};
  PcdRecords moved = read(text), kept = moved;
  moveToMap(moved, far, 1e-4);
  EXPECT_FALSE(hasFloatCoordinates(moved));
  EXPECT_EQ(valueOf<std::uint16_t>(moved, 0, 0), 7);
  EXPECT_EQ(valueOf<double>(moved, 1, 0), 500001.125);
  EXPECT_EQ(valueOf<double>(moved, 2, 0), -4099998.25);
  EXPECT_EQ(valueOf<double>(moved, 3, 0), 83.5);
  EXPECT_EQ(valueOf<std::uint64_t>(moved, 4, 0), 5u);
  moveToMap(kept, far, 0.5);  // a rounding of 0.25 m is allowed
  EXPECT_TRUE(hasFloatCoordinates(kept));
}

TEST_F(ExactPcd, AppendsFloatsToDoublesAndDoublesToFloats) {
  const std::string text = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n";
  PcdRecords wide = read(text);
  widenCoordinates(wide);
  PcdRecords all = read(text);
  append(all, wide);
  append(all, read(text));
  ASSERT_EQ(all.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(valueOf<double>(all, 2, i), 3.0);
}

}  // namespace
}  // namespace gaussmap::test
