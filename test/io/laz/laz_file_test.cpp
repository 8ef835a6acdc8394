// SPDX-License-Identifier: BSD-3-Clause
#include "io/laz/laz_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/files/temporary_directory.h"
#include "io/formats/scan_values.h"
#include "io/las/las_points.h"
#include "io/laz/laz_samples.h"

namespace gaussmap {
namespace {

using detail::openLaz;

class LazFiles : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& bytes) const { return directory_.write("cloud.laz", bytes); }
  std::string warningsOf(const std::string& bytes) const {
    std::string text;
    for (const std::string& warning : openLaz(write(bytes))->warnings()) text += warning + "\n";
    return text;
  }
  /// Returns the sample as a COPC file: with the record of COPC before the points.
  static std::string asCopc(std::string bytes) {
    std::string record(54 + 160, '\0');
    record.replace(2, 4, "copc");
    record[18] = 1;
    record[20] = static_cast<char>(160);
    const std::size_t points = test::dataOffset(bytes);
    const std::size_t table = test::tableOffset(bytes);
    bytes = test::changedAt(bytes, points, static_cast<std::uint64_t>(table + record.size()));
    bytes = test::changedAt(bytes, 96, static_cast<std::uint32_t>(points + record.size()));
    ++bytes[100];  // number of records
    return bytes.insert(points, record);
  }
  test::TemporaryDirectory directory_;
};

TEST_F(LazFiles, RecordsAreThoseOfTheIndependentReader) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::kLazFolder)) {
    if (entry.path().extension() != ".laz") continue;
    const std::string expected = test::expectedRecords(entry.path());
    EXPECT_FALSE(expected.empty()) << entry.path();
    EXPECT_TRUE(test::recordsOf(entry.path()) == expected) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 18);
}

TEST_F(LazFiles, CoordinatesAndValuesAreThoseOfTheRecords) {
  for (const char* const name : {"laszip_format1", "laszip_format3_extra", "laszip_format7", "laszip_format8_channels",
                                 "lazperf_format7_channels_variable"}) {
    const std::filesystem::path path = test::kLazFolder / (std::string(name) + ".laz");
    const std::string records = test::expectedRecords(path);
    const detail::LasHeader header = detail::openLazSource(path)->header;
    const auto reader = openLaz(path)->open(0);
    ASSERT_EQ(reader->size() * header.record_length, records.size());
    for (const std::size_t first : {std::size_t{0}, std::size_t{70}, std::size_t{149}, std::size_t{150}}) {
      PointBlock<3> block, expected;
      detail::decodeLasPoints(header, records.data() + first * header.record_length, reader->size() - first, expected);
      reader->read(first, block);
      ASSERT_EQ(block.size, expected.size);
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_TRUE(std::equal(block.coordinate[axis], block.coordinate[axis] + block.size, expected.coordinate[axis]));
    }
    std::string warning;
    for (const detail::LasField& field : detail::lasFields(header, warning)) {
      std::vector<double> expected(reader->size());
      detail::decodeLasField(field, header.record_length, records.data(), expected.size(), expected.data());
      if (field.kind == detail::LasField::Kind::Colour) detail::finishLasColours(expected);
      // NaN are compared as bytes.
      const std::vector<double> values = reader->values(field.name);
      EXPECT_EQ(std::memcmp(values.data(), expected.data(), expected.size() * sizeof(double)), 0)
          << name << " " << field.name;
    }
    EXPECT_THROW(reader->values("colour"), std::out_of_range);
  }
}

TEST_F(LazFiles, TheFileIsOneScanInTheMapFrame) {
  const auto file = openLaz(test::kLazFolder / "laszip_format3.laz");
  EXPECT_EQ(file->kind(), "LAZ 1.2, point format 3");
  EXPECT_EQ(file->size(), 1u);
  EXPECT_EQ(file->info(0).points, 150u);
  EXPECT_TRUE(file->inMapFrame());
  EXPECT_TRUE(file->warnings().empty());
  EXPECT_EQ(file->coordinateSystem(), "");
}

TEST_F(LazFiles, TheReaderCanOutliveTheFile) {
  auto file = openLaz(test::kLazFolder / "laszip_format0.laz");
  const auto reader = file->open(0);
  file.reset();
  PointBlock<3> block;
  reader->read(0, block);
  EXPECT_EQ(block.size, 150u);
}

TEST_F(LazFiles, LazIsRecognisedByItsStart) {
  const std::string bytes = test::lazSample("laszip_format7");
  EXPECT_TRUE(detail::isLaz(bytes.substr(0, 105)));
  EXPECT_FALSE(detail::isLaz(bytes.substr(0, 104)));
  EXPECT_FALSE(detail::isLaz(test::changedAt(bytes, 104, std::uint8_t{7})));
  EXPECT_FALSE(detail::isLaz("PLY" + bytes.substr(3)));
}

TEST_F(LazFiles, CopcIsReadLikeLaz) {
  const std::filesystem::path path = write(asCopc(test::lazSample("lazperf_format7_channels_variable")));
  EXPECT_EQ(openLaz(path)->kind(), "COPC (LAZ 1.4), point format 7");
  EXPECT_TRUE(test::recordsOf(path) == test::expectedRecords("lazperf_format7_channels_variable.laz"));
}

TEST_F(LazFiles, FilesWithoutATableOfChunksAreRead) {
  for (const char* const name : {"laszip_format1", "laszip_format8_channels", "laszip_format7_channels_variable"}) {
    std::string bytes = test::lazSample(name);
    const std::size_t points = test::dataOffset(bytes);
    bytes.resize(test::tableOffset(bytes));
    // The two values that writers leave there if they are interrupted.
    for (const std::int64_t position : {std::int64_t{-1}, static_cast<std::int64_t>(points + 8)}) {
      const std::string unfinished = test::changedAt(bytes, points, position);
      EXPECT_TRUE(test::recordsOf(write(unfinished)) == test::expectedRecords(std::string(name) + ".laz"));
      EXPECT_NE(warningsOf(unfinished).find("no table of chunks"), std::string::npos);
    }
  }
}

TEST_F(LazFiles, FilesWithoutPointsAreRead) {
  std::string bytes = test::lazSample("laszip_format0");
  bytes = test::changedAt(bytes, 107, std::uint32_t{0});
  bytes.resize(test::dataOffset(bytes));
  test::readAll(*detail::openLaz(write(bytes)));
  EXPECT_EQ(openLaz(write(bytes))->info(0).points, 0u);
}

TEST_F(LazFiles, APointOutsideOfTheBoxIsReported) {
  std::string bytes = test::lazSample("laszip_format0");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bytes = test::changedAt(bytes, 179 + 16 * axis, 2.0);
    bytes = test::changedAt(bytes, 187 + 16 * axis, 1.0);
  }
  EXPECT_NE(warningsOf(bytes).find("point 0 at"), std::string::npos);
}

}  // namespace
}  // namespace gaussmap
