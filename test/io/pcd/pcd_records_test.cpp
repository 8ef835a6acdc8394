// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/pcd_records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"

namespace gaussmap::test {
using namespace detail;

namespace {

/// Two points with every type, padding and a field of two elements; in a file of each encoding.
const std::string kHeader =
    "VERSION 0.7\nFIELDS x y z a _ b c d e f g h\nSIZE 4 4 8 1 3 2 4 8 1 2 4 8\nTYPE F F F I U I I I U U U U\n"
    "COUNT 1 1 1 1 1 1 2 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 2\nDATA ";

std::vector<std::string> columnsOfPoint(int i) {
  return {bytesOf(i ? 1.5f : -0.25f),
          bytesOf(i ? std::numeric_limits<float>::quiet_NaN() : 2.0f),
          bytesOf(i ? 0.1 : 1e7),
          bytesOf(std::int8_t(i ? -128 : 127)),
          std::string(3, i ? '\0' : '\0'),
          bytesOf(std::int16_t(i ? -32768 : 5)),
          bytesOf(std::int32_t(i ? -2147483647 - 1 : 6)) + bytesOf(std::int32_t(i ? 8 : -7)),
          bytesOf(std::int64_t(i ? -9007199254740992 : 9)),
          bytesOf(std::uint8_t(i ? 255 : 0)),
          bytesOf(std::uint16_t(i ? 65535 : 1)),
          bytesOf(std::uint32_t(i ? 4294967295u : 2)),
          bytesOf(std::uint64_t(i ? 9007199254740992 : 3))};
}

std::string joined(const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& part : parts) all += part;
  return all;
}

std::string textOf(const std::vector<char>& bytes) {
  return {bytes.begin(), bytes.end()};
}

template <typename T>
T valueOf(const PcdRecords& records, const std::string& field, std::size_t point) {
  for (const PcdField& one : records.fields) {
    if (one.name != field) continue;
    T value;
    EXPECT_EQ(one.size, sizeof(T));
    std::memcpy(&value, records.bytes.data() + point * records.record_size + one.offset, sizeof(T));
    return value;
  }
  ADD_FAILURE() << field;
  return {};
}

class PcdRecordsTest : public ::testing::Test {
 protected:
  PcdRecords read(const std::string& bytes) const { return readRecords(PcdReader(directory_.write("in.pcd", bytes))); }
  PcdRecords writtenAndRead(const PcdRecords& records) const {
    writePcd(directory_.path() / "out.pcd", records);
    return readRecords(PcdReader(directory_.path() / "out.pcd"));
  }
  /// n points (i, 10 i, 100 i) with the field id = i, in rows if width > 0.
  PcdRecords numbered(std::size_t n, std::size_t width = 0) const {
    std::string body;
    for (std::size_t i = 0; i < n; ++i)
      body += bytesOf(float(i)) + bytesOf(float(10 * i)) + bytesOf(float(100 * i)) + bytesOf(std::uint16_t(i));
    const std::string w = std::to_string(width > 0 ? width : n), h = std::to_string(width > 0 ? n / width : 1);
    return read("VERSION 0.7\nFIELDS x y z id\nSIZE 4 4 4 2\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH " + w + "\nHEIGHT " +
                h + "\nVIEWPOINT 4 5 6 0 1 0 0\nPOINTS " + std::to_string(n) + "\nDATA binary\n" + body);
  }

  TemporaryDirectory directory_;
};

TEST_F(PcdRecordsTest, AreTheSameFromEveryEncoding) {
  const std::vector<std::string> first = columnsOfPoint(0), second = columnsOfPoint(1);
  const std::string expected = joined(first) + joined(second);
  EXPECT_EQ(textOf(read(kHeader + "binary\n" + expected).bytes), expected);

  std::vector<std::string> by_field;  // DATA binary_compressed knows no padding
  for (std::size_t f = 0; f < first.size(); ++f)
    if (f != 4) by_field.push_back(first[f] + second[f]);
  EXPECT_EQ(textOf(read(kHeader + "binary_compressed\n" + compressedBody(joined(by_field))).bytes), expected);

  const PcdRecords ascii = read(kHeader +
                                "ascii\n-0.25 2 1e7 127 0 5 6 -7 9 0 1 2 3\n"
                                "1.5 nan 0.1 -128 0 -32768 -2147483648 8 -9007199254740992 255 65535 4294967295 "
                                "9007199254740992\n");
  PcdRecords of_binary = read(kHeader + "binary\n" + expected);
  EXPECT_TRUE(std::isnan(valueOf<float>(ascii, "y", 1)));
  std::vector<char> text = ascii.bytes;  // which NaN is nobody's business
  const std::size_t nan = ascii.record_size + 4;
  std::memcpy(text.data() + nan, of_binary.bytes.data() + nan, 4);
  EXPECT_EQ(textOf(text), expected);
  EXPECT_EQ(ascii.viewpoint.translation, Eigen::Vector3d(1, 2, 3));
}

TEST_F(PcdRecordsTest, OfTextBecomeTheNearestNumberThatFits) {
  const std::string header =
      "VERSION 0.7\nFIELDS x y z a b\nSIZE 4 4 4 1 2\nTYPE F F F I U\nCOUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n"
      "DATA ascii\n";
  const PcdRecords records = read(header + "0 0 0 300 -1\n0 0 0 -300 70000\n");
  EXPECT_EQ(valueOf<std::int8_t>(records, "a", 0), 127);
  EXPECT_EQ(valueOf<std::int8_t>(records, "a", 1), -128);
  EXPECT_EQ(valueOf<std::uint16_t>(records, "b", 0), 0);
  EXPECT_EQ(valueOf<std::uint16_t>(records, "b", 1), 65535);
}

TEST_F(PcdRecordsTest, AreWrittenAsTheyWereButForPadding) {
  const PcdRecords before = read(kHeader + "binary\n" + joined(columnsOfPoint(0)) + joined(columnsOfPoint(1)));
  const PcdRecords after = writtenAndRead(before);
  EXPECT_EQ(after.fields.size(), before.fields.size() - 1);
  EXPECT_EQ(after.record_size, before.record_size - 3);
  std::string expected;
  for (int i = 0; i < 2; ++i) {
    std::vector<std::string> columns = columnsOfPoint(i);
    columns.erase(columns.begin() + 4);
    expected += joined(columns);
  }
  EXPECT_EQ(textOf(after.bytes), expected);
  EXPECT_EQ(after.viewpoint.translation, Eigen::Vector3d(1, 2, 3));
}

TEST_F(PcdRecordsTest, KeepsOnlyWhatIsFlagged) {
  PcdRecords records = numbered(5);
  keepOnly(records, {false, true, false, true, true});
  ASSERT_EQ(records.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t id = std::vector<std::size_t>{1, 3, 4}[i];
    EXPECT_EQ(valueOf<std::uint16_t>(records, "id", i), id);
    EXPECT_EQ(valueOf<float>(records, "z", i), float(100 * id));
  }
  keepOnly(records, {false, false, false});
  EXPECT_EQ(records.size(), 0u);
  EXPECT_EQ(writtenAndRead(records).size(), 0u);
}

TEST_F(PcdRecordsTest, KeepsTheShapeOfAnOrganisedCloud) {
  PcdRecords records = numbered(6, 3);
  EXPECT_EQ(records.width, 3u);
  keepOnly(records, {true, false, true, true, true, true});
  const PcdRecords after = writtenAndRead(records);
  EXPECT_EQ(after.width, 3u);
  ASSERT_EQ(after.size(), 6u);
  for (const std::string axis : {"x", "y", "z"}) EXPECT_TRUE(std::isnan(valueOf<float>(after, axis, 1)));
  EXPECT_EQ(valueOf<std::uint16_t>(after, "id", 1), 1);
  EXPECT_EQ(valueOf<float>(after, "y", 2), 20.0f);
  const PcdReader reader(directory_.path() / "out.pcd");
  EXPECT_EQ(reader.header().height, 2u);
}

TEST_F(PcdRecordsTest, RefusesAWrongNumberOfFlags) {
  PcdRecords records = numbered(3), organised = numbered(6, 3);
  EXPECT_THROW(keepOnly(records, {true, true}), std::invalid_argument);
  EXPECT_THROW(keepOnly(records, std::vector<bool>(4)), std::invalid_argument);
  EXPECT_THROW(keepOnly(organised, std::vector<bool>(7)), std::invalid_argument);
  EXPECT_EQ(records.size(), 3u);
}

TEST_F(PcdRecordsTest, MoveToTheMapAndTurnTheirNormals) {
  // A quarter turn about z: x -> y, y -> -x.
  PcdRecords records = read(
      "VERSION 0.7\nFIELDS normal_z x y z normal_x normal_y\nSIZE 8 4 8 4 4 4\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\n"
      "WIDTH 1\nHEIGHT 1\nVIEWPOINT 9 9 9 1 0 0 0\nPOINTS 1\nDATA ascii\n0 1 2 3 1 0\n");
  Pose pose;
  pose.translation = {10, 20, 30};
  pose.rotation = Pose::Rotation(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  moveToMap(records, pose, 1.0);
  EXPECT_NEAR(valueOf<float>(records, "x", 0), 8.0, 1e-6);
  EXPECT_NEAR(valueOf<double>(records, "y", 0), 21.0, 1e-12);
  EXPECT_NEAR(valueOf<float>(records, "z", 0), 33.0, 1e-6);
  EXPECT_NEAR(valueOf<float>(records, "normal_x", 0), 0.0, 1e-6);
  EXPECT_NEAR(valueOf<float>(records, "normal_y", 0), 1.0, 1e-6);
  EXPECT_NEAR(valueOf<double>(records, "normal_z", 0), 0.0, 1e-12);
  EXPECT_EQ(records.viewpoint.translation, Eigen::Vector3d(0, 0, 0));
}

TEST_F(PcdRecordsTest, LeaveNormalsOfUnknownTypesAlone) {
  const std::string body = bytesOf(1.0f) + bytesOf(2.0f) + bytesOf(3.0f) + "abcdef";
  PcdRecords records = read(
      "VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 2 2 2\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\n"
      "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA binary\n" +
      body);
  Pose pose;
  pose.rotation = Pose::Rotation(0, 1, 0, 0);
  moveToMap(records, pose, 1.0);
  EXPECT_EQ(valueOf<float>(records, "y", 0), -2.0f);
  EXPECT_EQ(textOf(records.bytes).substr(12), "abcdef");
}

TEST_F(PcdRecordsTest, AppendPointsOfTheSameFieldsOnly) {
  PcdRecords all = numbered(6, 3);
  append(all, numbered(2));
  EXPECT_EQ(all.size(), 8u);
  EXPECT_EQ(all.width, 0u);
  EXPECT_EQ(valueOf<std::uint16_t>(all, "id", 7), 1);
  const PcdRecords others = read(xyzHeader(1, "binary") + std::string(12, '\0'));
  EXPECT_THROW(append(all, others), std::invalid_argument);
  PcdRecords other_type = numbered(2);
  other_type.fields.back().type = 'I';
  EXPECT_THROW(append(all, other_type), std::invalid_argument);
  EXPECT_EQ(all.size(), 8u);
}

TEST_F(PcdRecordsTest, MayBeNone) {
  for (const std::string encoding : {"ascii", "binary"}) {
    PcdRecords none = read(xyzHeader(0, encoding));
    EXPECT_EQ(none.size(), 0u);
    keepOnly(none, {});
    moveToMap(none, Pose(), 0.0);
    append(none, none);
    const PcdRecords after = writtenAndRead(none);
    EXPECT_EQ(after.size(), 0u);
    EXPECT_EQ(after.fields.size(), 3u);
  }
}

TEST_F(PcdRecordsTest, NeedFullRowsToBeWritten) {
  PcdRecords records = numbered(6, 3);
  records.width = 4;
  EXPECT_THROW(writePcd(directory_.path() / "out.pcd", records), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(directory_.path() / "out.pcd"));
}

}  // namespace
}  // namespace gaussmap::test
