// SPDX-License-Identifier: BSD-3-Clause
#include "io/las/las_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "io/files/temporary_directory.h"
#include "io/formats/scan_values.h"
#include "io/las/las_builder.h"

namespace gaussmap {
namespace {

using detail::openLas;
using test::LasBytes;

const std::filesystem::path kLasFolder = std::filesystem::path(GAUSSMAP_TEST_DATA) / "formats" / "las";

class LasFiles : public testing::Test {
 protected:
  std::unique_ptr<detail::ScanFile> open(const LasBytes& bytes) const {
    return openLas(directory_.write("cloud.las", bytes.str()));
  }
  /// Returns all warnings as one text.
  static std::string warningsOf(const detail::ScanFile& file) {
    std::string text;
    for (const std::string& warning : file.warnings()) text += warning + "\n";
    return text;
  }
  test::TemporaryDirectory directory_;
};

TEST_F(LasFiles, AllVersionsAndFormatsOfAnotherWriterAreRead) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kLasFolder)) {
    if (entry.path().extension() != ".las") continue;
    const auto file = openLas(entry.path());
    test::expectValuesOf(std::filesystem::path(entry.path()).replace_extension(".txt"), *file->open(0));
    EXPECT_EQ(warningsOf(*file), "") << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 16);
}

TEST_F(LasFiles, TheFileIsOneScanInTheMapFrame) {
  const auto file = openLas(kLasFolder / "format3_1.2.las");
  EXPECT_EQ(file->kind(), "LAS 1.2, point format 3");
  EXPECT_EQ(file->size(), 1u);
  EXPECT_EQ(file->info(0).points, 7u);
  EXPECT_FALSE(file->info(0).pose.has_value());
  EXPECT_TRUE(file->inMapFrame());
  EXPECT_EQ(file->coordinateSystem(), "EPSG:32632 (WGS 84 / UTM zone 32N)");
  for (const char* const name : {"format6_1.4.las", "format7_1.4.las"})  // the text is in an EVLR and in a VLR
    EXPECT_EQ(openLas(kLasFolder / name)->coordinateSystem().substr(0, 31), "PROJCS[\"WGS 84 / UTM zone 32N\",");
}

TEST_F(LasFiles, CoordinatesAreScaledInDouble) {
  LasBytes bytes;
  bytes.scale = {1e-7, 0.001, 0.5};
  bytes.offset = {636001.25, 5e6, 0.0};
  bytes.points = {{2147483647, -2147483647 - 1, 7}, {0, 1, -1}};
  const auto axes = test::coordinatesOf(*open(bytes)->open(0));
  EXPECT_EQ(axes[0], (std::vector<double>{2147483647 * 1e-7 + 636001.25, 636001.25}));
  EXPECT_EQ(axes[1], (std::vector<double>{-2147483648.0 * 0.001 + 5e6, 1 * 0.001 + 5e6}));
  EXPECT_EQ(axes[2], (std::vector<double>{3.5, -0.5}));
}

TEST_F(LasFiles, AReaderOutlivesItsFileAndReadsAnyBlock) {
  LasBytes bytes;
  bytes.points.clear();
  for (int i = 0; i < 1500; ++i) bytes.points.push_back({i, -i, 2 * i});
  bytes.count = 1500;
  const std::unique_ptr<ScanReader> reader = open(bytes)->open(0);
  PointBlock<3> block;
  reader->read(1400, block);
  ASSERT_EQ(block.size, 100u);
  EXPECT_EQ(block.coordinate[1][99], -1499 * 0.5 + 20.0);
  reader->read(700, block);
  EXPECT_EQ(block.size, PointBlock<3>::kCapacity);
  EXPECT_EQ(block.coordinate[0][0], 700 * 0.5 + 10.0);
  reader->read(1500, block);
  EXPECT_EQ(block.size, 0u);
  reader->read(static_cast<std::size_t>(-1), block);
  EXPECT_EQ(block.size, 0u);
  EXPECT_NO_THROW(reader->requireWhole());
  EXPECT_THROW(reader->values("height"), std::out_of_range);
}

TEST_F(LasFiles, AFileWithoutPointsIsAnEmptyScan) {
  LasBytes bytes;
  bytes.points.clear();
  bytes.count = 0;
  const auto file = open(bytes);
  EXPECT_EQ(file->open(0)->size(), 0u);
  EXPECT_TRUE(file->open(0)->values("intensity").empty());
  EXPECT_EQ(warningsOf(*file), "");
}

TEST_F(LasFiles, TheCountOf64BitsIsValid) {
  LasBytes bytes;
  bytes.minor = 4;
  bytes.legacy_count = 0;
  EXPECT_EQ(warningsOf(*open(bytes)), "");
  bytes.legacy_count = 1;
  EXPECT_EQ(open(bytes)->info(0).points, 2u);
  EXPECT_NE(warningsOf(*open(bytes)).find("2 points (byte 247) and 1 points"), std::string::npos);
  bytes.count = 0;
  bytes.legacy_count = 2;
  EXPECT_EQ(open(bytes)->info(0).points, 2u);
  EXPECT_NE(warningsOf(*open(bytes)).find("second number"), std::string::npos);
}

TEST_F(LasFiles, RoomForMorePointsIsAWarning) {
  LasBytes bytes;
  bytes.count = 1;
  EXPECT_EQ(open(bytes)->info(0).points, 1u);
  EXPECT_NE(warningsOf(*open(bytes)).find("1 points, but there is room for 2"), std::string::npos);
  bytes.minor = 4;
  bytes.count = 2;
  bytes.evlrs = test::evlr("somebody", 1, std::string(100, 'x'));
  bytes.evlr_count = 1;
  EXPECT_EQ(warningsOf(*open(bytes)), "");
}

TEST_F(LasFiles, PointsOutsideOfTheBoxAreAWarning) {
  LasBytes bytes;
  bytes.box = {10.5, 8.0, 22.5, 21.0, 30.75, 28.5};
  EXPECT_EQ(warningsOf(*open(bytes)), "");
  bytes.box[0] = 10.0;  // rounded
  EXPECT_EQ(warningsOf(*open(bytes)), "");
  bytes.box = {1050, 800, 2250, 2100, 3075, 2850};
  EXPECT_NE(warningsOf(*open(bytes)).find("point 0 at (10.5, 21, 30.75) is outside of the bounding box"),
            std::string::npos);
  bytes.box = {0, 1, 0, 0, 0, 0};
  EXPECT_NE(warningsOf(*open(bytes)).find("is not a box"), std::string::npos);
}

TEST_F(LasFiles, ColoursOf8BitsInOneFileAndOf16BitsInAnotherBecome8Bits) {
  LasBytes bytes;
  bytes.format = 2;
  bytes.record_length = 26;
  std::string text = bytes.str();
  text[bytes.dataOffset() + 20] = 17;
  text[bytes.dataOffset() + 26 + 24] = 5;
  const auto read = [&] { return openLas(directory_.write("cloud.las", text))->open(0)->values("rgb"); };
  EXPECT_EQ(read(), (std::vector<double>{17 << 16, 5}));
  text[bytes.dataOffset() + 23] = 3;  // green = 768
  EXPECT_EQ(read(), (std::vector<double>{3 << 8, 0}));
}

TEST_F(LasFiles, ExtraBytesThatDoNotFitAreIgnoredWithAWarning) {
  LasBytes bytes;
  bytes.record_length = 22;
  const std::string half = test::padded(std::string("\0\0\3\0height", 10), 192);
  const auto names = [&] { return open(bytes)->open(0)->valueNames(); };
  const std::size_t without = names().size();
  bytes.vlrs = test::vlr("LASF_Spec", 4, half);
  bytes.vlr_count = 1;
  EXPECT_EQ(names().back(), "height");
  EXPECT_EQ(warningsOf(*open(bytes)), "");
  bytes.vlrs = test::vlr("LASF_Spec", 4, half + half);
  EXPECT_EQ(names().size(), without);
  EXPECT_NE(warningsOf(*open(bytes)).find("describes more bytes than the 22"), std::string::npos);
  bytes.vlrs = test::vlr("LASF_Spec", 4, test::padded(std::string("\0\0\37\0height", 10), 192));
  EXPECT_NE(warningsOf(*open(bytes)).find("unknown type"), std::string::npos);
  bytes.vlrs = test::vlr("LASF_Spec", 4, half.substr(0, 191));  // not a whole description
  EXPECT_EQ(names().size(), without);
  bytes.vlrs = test::vlr("LASF_Spec", 4, test::padded(std::string("\0\0\3\0intensity", 13), 192));  // a name of LAS
  EXPECT_EQ(names().size(), without);
}

TEST_F(LasFiles, LasIsRecognisedAndLazIsNot) {
  LasBytes bytes;
  EXPECT_TRUE(detail::isLas(bytes.str()));
  EXPECT_TRUE(detail::isLas("LASF"));
  EXPECT_FALSE(detail::isLas("LAS"));
  EXPECT_FALSE(detail::isLas(""));
  EXPECT_FALSE(detail::isLas("~VERSION INFORMATION"));  // a well log
  bytes.format = 128 + 3;
  EXPECT_FALSE(detail::isLas(bytes.str()));
}

}  // namespace
}  // namespace gaussmap
