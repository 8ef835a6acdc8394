// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "io/files/file_contents.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/text/cloud_text.h"
#include "io/text/text_data.h"

namespace gaussmap::detail {
namespace {

class BadCloudTexts : public testing::Test {
 protected:
  std::string complaint(const std::filesystem::path& path, const std::string& fields = "") const {
    return test::complaintOf([&] { test::rowsOf(*openCloudText(path, {fields})); });
  }
  /// Expects an error that names the file and contains every piece.
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces,
                     const std::string& fields = "") const {
    const std::filesystem::path path = directory_.write("scan.txt", bytes);
    test::expectComplaint(complaint(path, fields), path, pieces);
  }
  test::TemporaryDirectory directory_;
};

TEST_F(BadCloudTexts, WhatIsNoCloudIsRefused) {
  expectRefused("", {"the file is empty"});
  expectRefused("\n \n", {"line 3", "no row of numbers"});
  expectRefused("# nothing\n", {"line 2", "no row of numbers"});
  expectRefused(std::string("1 2 3\n\0", 7), {"byte 6 is zero"});
  expectRefused(
      "\xFF\xFE"
      "1",
      {"UTF-16", "UTF-8"});
  expectRefused("once upon a time\n", {"line 1: 'once' is not a number", "x, y and z", "--fields"});
  expectRefused("1 2\n3 4\n", {"line 1: 2 columns instead of x, y and z"});
  expectRefused("1.5\n2.5\n", {"line 1: one column instead of x, y and z"});
  expectRefused("1\n2\n", {"line 2: a second line with one number", "line 1"});
  expectRefused(std::string(70000, '1'), {"line 1: is longer than 64 KiB"});
  expectRefused(std::string(20000, '1') + "\r" + std::string(60000, '1'), {"CR only"});
  std::string wide;
  for (int i = 0; i < 1001; ++i) wide += "1 ";
  expectRefused(wide, {"more than 1000 columns"});
}

TEST_F(BadCloudTexts, RowsWithAnotherNumberOfColumnsAreRefused) {
  expectRefused("1 2 3\n4 5 6\n7 8\n", {"line 3: 2 columns instead of 3"});
  expectRefused("1 2 3\n\n# c\n4 5 6 7\n", {"line 4: 4 columns instead of 3"});
  expectRefused("1,2,3\n4,5\n", {"line 2: 2 columns instead of 3"});
  expectRefused("1,2,3\n4,5,6,7\n", {"line 2: 4 columns instead of 3"});
  expectRefused("1,2,3\n4 5 6\n", {"line 2: 1 column instead of 3"});
  expectRefused("1 2 3\n4,5,6\n", {"line 2: 1 column instead of 3"});
  std::string many;
  for (int i = 0; i < 3000; ++i) many += "1 2 3\n";
  expectRefused(many + "1 2\n" + many, {"line 3001: 2 columns instead of 3"});
}

TEST_F(BadCloudTexts, WordsThatAreNotNumbersAreRefused) {
  expectRefused("1 2 3\n1 2 three\n", {"line 2", "'three'"});
  expectRefused("1 2 3\n1 2 0x10\n", {"line 2", "'0x10'"});
  expectRefused("1 2 3\n1 1e999 3\n", {"line 2", "'1e999' does not fit a double"});
  expectRefused("x,y,z\n1,2,abc\n", {"line 2: 'abc' is not a number, but column 3 'z' must be z"});
}

TEST_F(BadCloudTexts, DecimalCommasAreRefused) {
  expectRefused("1,5;2,5;3,5\n", {"line 1", "'1,5'", "1.5, not 1,5"});
  expectRefused("x;y;z\n1,5;2,5;3,5\n", {"1.5, not 1,5"});
  expectRefused("1,5 2,5 3,5\n", {"line 1", "1.5, not 1,5"});
  expectRefused("1.5;2.5;3.5\n1,5;2,5;3,5\n", {"line 2", "'1,5'", "1.5, not 1,5"});
  expectRefused("1,2,3\n1,5 2,5 3,5\n", {"line 2: 4 columns instead of 3"});
  expectRefused("1,2,3\n1,5 2,5\n", {"line 2", "'5 2'"});
}

TEST_F(BadCloudTexts, NumbersOfPointsAreChecked) {
  expectRefused("3\n1 2 3 4\n1 2 3 4\n", {"line 4: the file ends after 2 of the 3 points of line 1"});
  expectRefused("1\n1 2 3 4\n1 2 3 4\n", {"line 3: more rows than the 1 points of line 1", "delete line 1"});
  expectRefused("99999999999999999999\n1 2 3 4\n", {"line 1", "not the number of points"});
  expectRefused("1000000000\n1 2 3 4\n", {"line 1: 1000000000 points do not fit in the 8 bytes"});
  expectRefused("1\n1 2 3\n0\n", {"line 3: a scan with 0 points"});
  expectRefused("0\n0\n", {"line 2"});
  expectRefused("2\n1 2 3\n4\n1 2 3\n", {"line 4: more rows than the 2 points of line 1"});
  expectRefused("2\n1 2 3\n1\n1\n1 2 3\n", {"line 3: 1 column instead of 3"});
}

TEST_F(BadCloudTexts, HeadersThatDoNotFitAreRefused) {
  expectRefused("x y z\n1 2 3 4\n", {"line 2: 4 columns, but line 1 names 3", "--fields"});
  expectRefused("x y z i\n1 2 3\n", {"line 2: 3 columns, but line 1 names 4"});
  expectRefused("x y z x\n1 2 3 4\n", {"line 1: two columns are named 'x'"});
  expectRefused("x [ft],y [ft],z [ft]\n1,2,3\n", {"line 1: the unit of 'x [ft]' is unknown", "metres"});
  expectRefused("1 2 3 4\n", {"line 1: 4 columns, but --fields names 3"}, "x y z");
}

TEST_F(BadCloudTexts, ColumnsThatAreCertainlyNotXAreRefused) {
  std::string counted, timed, relative, classes;
  for (int i = 0; i < 20; ++i) {
    counted += std::to_string(i) + " 1.5 2.5 3.5\n";
    timed += "17000000" + std::to_string(10 + i) + ".5 1.5 2.5 3.5\n";
    relative += std::to_string(0.1 * i * i) + " 1.5 2.5 3.5\n";
    classes += std::to_string(i % 3) + " " + std::to_string(0.5 + i % 4) + " " + std::to_string(1.5 - i % 5) + " 3.5\n";
  }
  for (const char* const unclear : {"1 2 3 4 5\n", "1 2 3 5.5 -6 7\n", "1 2 3 5 6 7 1000\n", "1 2 3 4 5 6 7\n"})
    expectRefused(unclear, {"columns without names; name the columns, for example with --fields"});
  expectRefused("lat,lon,alt\n52.1,13.2,30\n", {"names degrees, but a map needs metres"});
  expectRefused(relative, {"column 1 grows from row to row"});
  expectRefused(classes, {"column 1 holds whole numbers like an index or a class"});
  expectRefused("1.5 2.5 3.5 0.5\n2.5 2.5 3.5 -0.25\n", {"the last one is negative in places"});
  expectRefused(counted, {"column 1 grows from row to row", "--fields \"- x y z\""});
  expectRefused(timed, {"column 1 holds times", "--fields \"time x y z\""});
  expectRefused("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n", {"8 columns without names", "--fields"});
}

TEST_F(BadCloudTexts, ColoursOutOfRangeAreRefused) {
  std::string text = "x y z r g b\n";
  for (int i = 0; i < 600; ++i) text += "1 2 3 " + std::string(i == 100 ? "300" : "3") + " 4 5\n";
  expectRefused(text, {"point 100: the colour 300 is not between 0 and 255"});
  expectRefused("x y z rgb\n1 2 3 0.5\n", {"the colour 0.5"});
}

TEST_F(BadCloudTexts, FieldsThatAreNotValidAreWrongUsage) {
  const std::filesystem::path path = directory_.write("scan.txt", "1 2 3\n");
  for (const char* const fields : {"x y", "x y z x", "x:f32 y z", "x y z:", "x:ft y z", "x:mm:cm y z", ": x y z", "-"})
    EXPECT_THROW(openCloudText(path, {fields}), std::invalid_argument) << fields;
}

TEST_F(BadCloudTexts, MutationsAreReadOrRefused) {
  std::vector<std::string> good;
  for (const char* const name : {"two.ptx", "two.pts", "paraview.csv", "cloudcompare.asc", "plain.xyz"})
    good.push_back(test::contentsOf(test::textData(name)));
  test::expectMutationsReadOrRefused(good, [&](const std::string& bytes) {
    isCloudText(bytes);
    test::rowsOf(*openCloudText(directory_.write("scan.txt", bytes)));
  });
}

}  // namespace
}  // namespace gaussmap::detail
