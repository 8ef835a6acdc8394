// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/cloud_text.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "io/files/file_contents.h"
#include "io/files/temporary_directory.h"
#include "io/text/text_data.h"

namespace gaussmap::detail {
namespace {

using test::contentsOf;
using test::namesIn;
using test::numbersOf;
using test::rowsOf;
using test::TemporaryDirectory;
using test::textData;
using test::textOf;

class CloudTexts : public testing::Test {
 protected:
  std::unique_ptr<ScanFile> open(const std::string& bytes, const std::string& fields = "") const {
    return openCloudText(directory_.write("scan.txt", bytes), {fields});
  }
  /// Expects these points with their values, and no warning.
  void expectRows(const std::string& bytes, const std::string& names, const std::string& rows,
                  const std::string& fields = "") const {
    const std::unique_ptr<ScanFile> file = open(bytes, fields);
    EXPECT_EQ(namesIn(*file), names) << bytes;
    EXPECT_EQ(textOf(rowsOf(*file)), rows) << bytes;
    EXPECT_EQ(file->warnings(), std::vector<std::string>()) << bytes;
  }
  /// Expects a warning with this piece.
  void expectWarning(const std::string& bytes, const std::string& names, const std::string& piece,
                     const std::string& fields = "") const {
    const std::unique_ptr<ScanFile> file = open(bytes, fields);
    EXPECT_EQ(namesIn(*file), names) << bytes;
    ASSERT_EQ(file->warnings().size(), 1u) << bytes;
    EXPECT_NE(file->warnings()[0].find(piece), std::string::npos) << file->warnings()[0];
  }
  TemporaryDirectory directory_;
};

TEST_F(CloudTexts, EqualWhatNumpyReads) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"plain.xyz", "intensity"},
      {"exponents.txt", ""},
      {"utm.csv", ""},
      {"paraview.csv", "ring intensity"},
      {"cloudcompare.asc", "rgb normal_x normal_y normal_z"},
      {"two.pts", "intensity rgb"},
      {"normals.txt", "normal_x normal_y normal_z"},
      {"times.csv", "time intensity"},
      {"nan.xyz", ""}};
  for (const auto& [name, values] : files) {
    const std::unique_ptr<ScanFile> file = openCloudText(textData(name));
    EXPECT_EQ(textOf(rowsOf(*file)), textOf(numbersOf(textData(name + ".expected")))) << name;
    EXPECT_EQ(namesIn(*file), values) << name;
    EXPECT_EQ(file->warnings(), std::vector<std::string>()) << name;
    EXPECT_TRUE(isCloudText(contentsOf(textData(name)))) << name;
  }
}

TEST_F(CloudTexts, PtsFilesHaveOneScanPerNumberOfPoints) {
  const std::unique_ptr<ScanFile> file = openCloudText(textData("two.pts"));
  ASSERT_EQ(file->size(), 2u);
  EXPECT_EQ(file->info(0).points, 40u);
  EXPECT_EQ(file->info(1).points, 7u);
  EXPECT_EQ(file->info(1).name, "scan 1");
  EXPECT_FALSE(file->info(1).pose);
  EXPECT_EQ(file->kind(), "PTS text, 7 columns separated by blanks");
}

TEST_F(CloudTexts, ReadFromAnyPointOn) {
  std::string text;
  for (int i = 0; i < 2000; ++i) text += std::to_string(i) + " 0.5 1\n" + (i % 7 == 0 ? "# comment\n\n" : "");
  const std::unique_ptr<ScanReader> reader = open(text)->open(0);
  ASSERT_EQ(reader->size(), 2000u);
  PointBlock<3> block;
  for (const std::size_t first : std::vector<std::size_t>{0, 1, 511, 512, 513, 1000, 1999, 1488}) {
    reader->read(first, block);
    ASSERT_EQ(block.size, std::min<std::size_t>(512, 2000 - first));
    for (std::size_t i = 0; i < block.size; ++i) EXPECT_EQ(block.coordinate[0][i], static_cast<double>(first + i));
  }
  reader->read(2000, block);
  EXPECT_EQ(block.size, 0u);
  EXPECT_THROW(reader->values("intensity"), std::out_of_range);
}

TEST_F(CloudTexts, CanHaveBlanksCommentsAndAnyLineEnd) {
  const std::string expected = "1 2 3\n4 5 6\n";
  for (const char* const text :
       {"1 2 3\n4 5 6\n", "1 2 3\n4 5 6", "1 2 3\r\n4 5 6\r\n",
        "\xEF\xBB\xBF"
        "1 2 3\n4 5 6\n",
        "1\t2\t3\n4\t5\t6\n", "1,2,3\n4,5,6\n", "1;2;3\n4;5;6\n", "1, 2, 3\n4 ,5 ,  6 \n",
        "  1   2 \t 3  \n\n\n 4 5 6\n\n", "# a comment\n1 2 3\n// another\n% and one\n4 5 6 # behind\n#",
        "1,2,3,\n4,5,6,\n", "\"1\",\"2\",\"3\"\n4,\"5\",6", "\"1\" \"2\" \"3\"\n4 5 6", "+1 2. 3e0\n4 .5e1 6E+0\n",
        "1;2;3 % comment\n4;5;6;\n"})
    expectRows(text, "", expected);
}

TEST_F(CloudTexts, NamesCanStandInAHeader) {
  for (const char* const header :
       {"x y z\n", "X Y Z\n", "# x y z\n", "#x,y,z\n", "//X Y Z\n", "% x;y;z\n", "x,y,z\n", "x\ty\tz\n",
        "x [m] y [m] z [m]\n", "x[m] y(m) Z_m\n", "\"x\" \"y\" \"z\"\n", "Points:0 Points:1 Points:2\n",
        "\"Points:0\",\"Points:1\",\"Points:2\"\n", "Easting Northing Elevation\n", "# a cloud\n# x y z\n",
        "x y z\n2\n", "x\t y\t z\r\n"})
    expectRows(std::string(header) + "1 2 3\n4 5 6\n", "", "1 2 3\n4 5 6\n");
  expectRows("x,y,z\n1 2 3\n", "", "1 2 3\n");
  expectRows("z y x\n1 2 3\n", "", "3 2 1\n");
  expectRows("x y z\n", "", "");
  expectRows("x y z i\n1 2 3 4\n", "intensity", "1 2 3 4\n");
  expectRows("x y z reflectance t ring nx ny nz label range\n1 2 3 4 5 6 7 8 9 10 11\n",
             "intensity time ring normal_x normal_y normal_z label range", "1 2 3 4 5 6 7 8 9 10 11\n");
  expectRows("x y z r g b\n1 2 3 1 2 3\n", "rgb", "1 2 3 66051\n");
  expectRows("x y z Red Green Blue\n1 2 3 0.5 0 1\n", "rgb", "1 2 3 8388863\n");
  expectRows("x y z rgb\n1 2 3 16777215\n4 5 6 4278190081\n", "rgb", "1 2 3 16777215\n4 5 6 1\n");
  expectRows("x y z r\n1 2 3 4\n", "r", "1 2 3 4\n");
}

TEST_F(CloudTexts, UnitsInTheHeaderAreUsed) {
  expectRows("x [mm],y [mm],z [cm]\n1500,2,3\n", "", "1.5 0.002 0.029999999999999999\n");
  expectRows("x y z time_us\n1 2 3 1500000\n", "time", "1 2 3 1.5\n");
  expectRows("TIMESTAMP (ns), RANGE (mm), X (m), Y (m), Z (m)\n2000000000, 500, 1, 2, 3\n", "time RANGE",
             "1 2 3 2 500\n");
}

TEST_F(CloudTexts, TheBestOfSeveralNamesIsUsed) {
  // VeloView writes both.
  expectRows("Points_m_XYZ:0,Points_m_XYZ:1,Points_m_XYZ:2,X,Y,Z,intensity,laser_id\n9,9,9,1,2,3,4,5\n",
             "Points_m_XYZ:0 Points_m_XYZ:1 Points_m_XYZ:2 intensity ring", "1 2 3 9 9 9 4 5\n");
  expectRows("x y z intensity intensity a a\n1 2 3 4 5 6 7\n", "intensity intensity_2 a a_2", "1 2 3 4 5 6 7\n");
}

TEST_F(CloudTexts, ColumnsWithoutNamesAreFoundFromTheirValues) {
  expectRows("1 2 3 0.5\n", "intensity", "1 2 3 0.5\n");
  expectRows("1 2 3 0 128 255\n", "rgb", "1 2 3 33023\n");
  expectRows("1 2 3 0 0 1\n4 5 6 0 -1 0\n", "normal_x normal_y normal_z", "1 2 3 0 0 1\n4 5 6 0 -1 0\n");
  expectRows("1 2 3 0 0 1\n4 5 6 1 0 0\n", "normal_x normal_y normal_z", "1 2 3 0 0 1\n4 5 6 1 0 0\n");
  expectRows("1 2 3 -2048 1 2 3\n", "intensity rgb", "1 2 3 -2048 66051\n");
  expectRows("1 2 3 1 2 3 0 0 1\n", "rgb normal_x normal_y normal_z", "1 2 3 66051 0 0 1\n");
  expectWarning("1 2 3 0.5 0.1 0.2\n", "rgb", "columns 4 to 6");
  expectRows("1 2 3 -2048\n2 2 3 2047\n", "intensity", "1 2 3 -2048\n2 2 3 2047\n");  // of Leica
}

TEST_F(CloudTexts, TheUserCanNameTheColumns) {
  expectRows("1 2 3 4\n", "time", "2 3 4 1\n", "t x y z");
  expectRows("1 2 3 4\n", "", "2 3 4\n", "- x y z");
  expectRows("1 2 3 4\n", "ring", "1 2 3 4\n", "x y z ring");
  expectRows("1000,2,3,7\n", "time", "1 0.002 0.0030000000000000001 0.0070000000000000001\n", "x:mm,y:mm,z:mm,time:ms");
  expectRows("a b c d\n1 2 3 4\n", "d", "1 2 3 4\n", "x y z d");
  expectRows("car 1 2 3\n", "", "1 2 3\n", "- x y z");
  expectRows("x y z intensity\n1 2 3 4\n", "", "1 2 4\n", "x y - z");
}

TEST_F(CloudTexts, MissingValuesAreNaN) {
  expectRows("x,y,z,label\n1,2,3,\n4,5,6,7\n", "label", "1 2 3 nan\n4 5 6 7\n");
  expectRows("1,,3\n4,5,6\n", "", "1 nan 3\n4 5 6\n");
  expectRows("nan NaN NAN\n-nan(ind) 1.#QNAN -1.#IND\n1 2 3\n", "", "nan nan nan\nnan nan nan\n1 2 3\n");
  expectRows("inf -Infinity 1.#INF\n1 N/A NULL\n", "", "inf -inf inf\n1 nan nan\n");
  expectRows("x\ty\tz\ta\tb\n1\t2\t3\t\t5\n", "a b", "1 2 3 nan 5\n");
}

TEST_F(CloudTexts, ColumnsWithTextsAreNotUsed) {
  expectWarning("x,y,z,code\n1,2,3,0x00000000\n", "", "hold texts and are not used: column 4 'code'");
  expectWarning("x,y,z,name,i\n1,2,3,\"a, b\",5\n", "intensity", "column 4 'name'");
}

TEST_F(CloudTexts, TimesWithoutAUnitAreGuessedWithAWarning) {
  expectWarning("x y z time\n1 2 3 1700000000123456789\n", "time", "taken as nanoseconds");
  expectWarning("x y z time\n1 2 3 0\n1 2 3 99999999\n", "time", "taken as seconds");
  expectRows("x y z time\n1 2 3 1700000000.5\n", "time", "1 2 3 1700000000.5\n");
}

TEST_F(CloudTexts, CoordinatesKeepAllDigits) {
  expectRows("452345.12345678912 5412345.6789012346 0.1\n", "",
             "452345.12345678912 5412345.6789012346 0.10000000000000001\n");
}

TEST(IsCloudText, RefusesOtherTextsAndBinaries) {
  for (const char* const text : {"", "\n", "ply\nformat ascii 1.0\n", "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\n",
                                 "OFF\n8 6 12\n", "{\"x\": 1}\n", "<xml>\n", "once upon a time\n", "1 2\n3 4\n", "5\n",
                                 "# only a comment\n", "FLASER 3 1 2 3 0 0 0 0 0 0 0 h 0\n", "v 1 2 3\n", "1 2 3\x01\n",
                                 "%YAML 1.0\nx: 1\n", "x y\n1 2\n", "image: map.pgm\nresolution: 0.05\n"})
    EXPECT_FALSE(isCloudText(text)) << text;
  EXPECT_FALSE(isCloudText(std::string("1 2 3\n\0", 7)));
}

TEST(IsCloudText, AcceptsAStartThatEndsAnywhere) {
  for (const char* const text : {"1 2 3", "1 2 3\n4 5", "x,y,z\n1,2", "12\n1 2 3 4 5 6 7\n1", "# note\n1 2 3\n"})
    EXPECT_TRUE(isCloudText(text)) << text;
}

}  // namespace
}  // namespace gaussmap::detail
