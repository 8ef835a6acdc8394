// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "io/files/file_contents.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/text/cloud_text.h"
#include "io/text/text_data.h"

namespace gaussmap::detail {
namespace {

using test::namesIn;
using test::numbersOf;
using test::rowsOf;
using test::textData;
using test::textOf;

constexpr const char* kAxes = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
constexpr const char* kIdentity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

class PtxFiles : public testing::Test {
 protected:
  std::unique_ptr<ScanFile> open(const std::string& bytes) const {
    return openCloudText(directory_.write("scan.ptx", bytes));
  }
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces) const {
    const std::filesystem::path path = directory_.write("scan.ptx", bytes);
    test::expectComplaint(test::complaintOf([&] { rowsOf(*openCloudText(path)); }), path, pieces);
  }
  void expectMatrixRefused(const std::string& matrix, const std::string& piece) const {
    expectRefused("1\n1\n" + std::string(kAxes) + matrix + "1 2 3 0.5\n", {"line 10: the matrix of scan 0", piece});
  }
  test::TemporaryDirectory directory_;
};

/// Returns the points of all scans in the map frame.
std::vector<Eigen::Vector3d> pointsInMap(const ScanFile& file) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t scan = 0; scan < file.size(); ++scan)
    for (const std::vector<double>& row : rowsOf(*file.open(scan)))
      points.push_back(file.info(scan).pose.value() * Eigen::Vector3d(row[0], row[1], row[2]));
  return points;
}

TEST_F(PtxFiles, EqualWhatAnotherReaderReads) {
  const std::unique_ptr<ScanFile> file = openCloudText(textData("two.ptx"));
  const std::vector<std::vector<double>> expected = numbersOf(textData("two.ptx.expected"));
  const std::vector<std::vector<double>> rows = rowsOf(*file);
  const std::vector<Eigen::Vector3d> in_map = pointsInMap(*file);
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double>& row = expected[i];
    EXPECT_EQ(textOf({{rows[i].begin(), rows[i].begin() + 4}}), textOf({{row.begin() + 3, row.begin() + 7}}));
    if (rows[i].size() > 4) {
      EXPECT_EQ(rows[i][4], row[7]);
    }
    EXPECT_EQ(std::isnan(in_map[i].x()), std::isnan(row[0]));
    if (!std::isnan(row[0])) {
      EXPECT_LT((in_map[i] - Eigen::Vector3d(row[0], row[1], row[2])).norm(), 1e-7);
    }
  }
  EXPECT_TRUE(isCloudText(test::contentsOf(textData("two.ptx"))));
  EXPECT_EQ(file->warnings(), std::vector<std::string>());
}

TEST_F(PtxFiles, EqualWhatCloudCompareReads) {
  const std::vector<std::vector<double>> expected = numbersOf(textData("two.ptx.cloudcompare"));
  std::size_t next = 0;
  for (const Eigen::Vector3d& point : pointsInMap(*openCloudText(textData("two.ptx")))) {
    if (std::isnan(point.x())) continue;
    ASSERT_LT(next, expected.size());
    const std::vector<double>& row = expected[next++];
    EXPECT_LT((point - Eigen::Vector3d(row[0], row[1], row[2])).norm(), 1e-4) << next;  // floats at 450 m
  }
  EXPECT_EQ(next, expected.size());
}

TEST_F(PtxFiles, ScansHaveTheirPoseAndGrid) {
  const std::unique_ptr<ScanFile> file = openCloudText(textData("two.ptx"));
  ASSERT_EQ(file->size(), 2u);
  EXPECT_EQ(file->kind(), "PTX text");
  EXPECT_EQ(file->info(1).name, "scan 1");
  EXPECT_EQ(file->info(0).points, 20u);
  EXPECT_EQ(file->open(0)->columns(), 4);
  EXPECT_EQ(file->open(1)->columns(), 6);
  EXPECT_EQ(file->info(1).pose->translation, Eigen::Vector3d(451.5, 0.0, 7.0));
  EXPECT_EQ(namesIn(*file), "intensity rgb");
  EXPECT_EQ(file->open(1)->valueNames(), std::vector<std::string>{"intensity"});
}

TEST_F(PtxFiles, TheLastRowOfTheMatrixIsTheTranslationAndRowsAreTheAxes) {
  // A turn by 90 degrees about z: the x axis of the scanner is the y axis of the map.
  const std::unique_ptr<ScanFile> file = open(
      "1\r\n2\r\n451000.25 5 6\r\n0 1 0\r\n-1 0 0\r\n0 0 1\r\n"
      "0 1 0 0\r\n-1 0 0 0\r\n0 0 1 0\r\n451000.25 5 6 1\r\n1 0 0 0.5\r\n0 0 0 0.5\r\n");
  const std::vector<Eigen::Vector3d> points = pointsInMap(*file);
  EXPECT_LT((points[0] - Eigen::Vector3d(451000.25, 6.0, 6.0)).norm(), 1e-9);
  EXPECT_TRUE(std::isnan(points[1].x()));
  EXPECT_EQ(file->warnings(), std::vector<std::string>());
  EXPECT_EQ(textOf(rowsOf(*file)), "1 0 0 0.5\nnan nan nan 0.5\n");
}

TEST_F(PtxFiles, RowsCanHaveOtherNumbersOfColumns) {
  const std::string head = "1\n1\n" + std::string(kAxes) + kIdentity;
  EXPECT_EQ(textOf(rowsOf(*open(head + "1 2 3\n"))), "1 2 3\n");
  EXPECT_EQ(textOf(rowsOf(*open(head + "1 2 3 0 0 255\n"))), "1 2 3 255\n");
  EXPECT_EQ(open("0\n0\n" + std::string(kAxes) + kIdentity)->info(0).points, 0u);
}

TEST_F(PtxFiles, AnotherPositionBesideTheMatrixIsSaid) {
  const std::unique_ptr<ScanFile> file =
      open("1\n1\n7 8 9\n1 0 0\n0 1 0\n0 0 1\n" + std::string(kIdentity) + "1 2 3 0.5\n");
  ASSERT_EQ(file->warnings().size(), 1u);
  EXPECT_NE(file->warnings()[0].find("the position of the scanner"), std::string::npos);
}

TEST_F(PtxFiles, MatricesThatAreNoPoseAreRefused) {
  expectMatrixRefused("2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n", "scales or shears");
  expectMatrixRefused("1 0.1 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "scales or shears");
  expectMatrixRefused("0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 1\n", "scales or shears");
  expectMatrixRefused("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n", "mirrors");
  expectMatrixRefused("1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n", "is transposed");
  expectMatrixRefused("1 0 0 1\n0 1 0 0\n0 0 1 0\n1 2 3 1\n", "column 0 0 0 1");
  expectMatrixRefused("1 0 0 0\n0 nan 0 0\n0 0 1 0\n0 0 0 1\n", "not finite");
}

TEST_F(PtxFiles, DamagedFilesAreRefused) {
  const std::string axes = kAxes, identity = kIdentity;
  expectRefused("1\n1\n0 0 0\n", {"line 4: the file ends instead of 3 numbers: an axis of the scanner of scan 0"});
  expectRefused("1\n1\n0 0 0\n1 0\n", {"line 4: 2 words instead of 3 numbers"});
  expectRefused("1\n1\n" + axes + "1 0 0 x\n", {"line 7: 'x' instead of 4 numbers: a row of the matrix"});
  expectRefused("1.5\n1\n" + axes, {"line 1: the number of columns of scan 0 must be a whole number"});
  expectRefused("-1\n1\n" + axes, {"line 1: the number of columns"});
  expectRefused("1\n9999999999\n" + axes, {"line 2: the number of rows"});
  expectRefused("2147483647\n2147483647\n" + axes + identity + "1 2 3 4\n", {"do not fit in the 8 bytes"});
  expectRefused("2\n1\n" + axes + identity + "1 2 3 4\n",
                {"line 12: the file ends after 1 of the 2 x 1 points of line 1"});
  expectRefused("1\n1\n" + axes + identity + "1 2 3 4 5\n", {"line 11: 5 columns"});
  expectRefused("2\n1\n" + axes + identity + "1 2 3 4\n1 2 3\n", {"line 12: 3 columns instead of 4"});
  expectRefused("1\n1\n" + axes + identity + "1 2 3 4\n1 2 3 4\n", {"line 12: 4 words instead of 1 number", "scan 1"});
}

}  // namespace
}  // namespace gaussmap::detail
