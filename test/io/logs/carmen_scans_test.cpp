// SPDX-License-Identifier: BSD-3-Clause
#include "io/logs/carmen_scans.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gaussmap/core/error.h"
#include "gaussmap/core/scans.h"
#include "io/files/temporary_directory.h"
#include "io/logs/gzip.h"
#include "io/scans/open_scan_file.h"

namespace gaussmap {
using namespace detail;

namespace {

class CarmenScansTest : public testing::Test {
 protected:
  std::shared_ptr<const ScanFile> open(const std::string& text, const std::string& name = "a.log") const {
    return openScanFile(directory_.write(name, text), OpenOptions());
  }
  test::TemporaryDirectory directory_;
};

const std::string kThreeBeams = "FLASER 3 1 81.9 2 4 5 1.5707963267948966 4 5 0 ";

TEST_F(CarmenScansTest, AreOnePerSweepWithItsPoseAndTime) {
  const auto file = open("PARAM a b\n" + kThreeBeams + "7.25 host 9\nODOM 1 2\n" + kThreeBeams + "7.5 host 9\n");
  EXPECT_EQ(file->kind(), "CARMEN log");
  ASSERT_EQ(file->size(), 2u);
  const FileScanInfo info = file->info(0);
  EXPECT_EQ(info.name, "scan 0");
  EXPECT_EQ(info.points, 3u);
  EXPECT_EQ(info.pose->translation, Eigen::Vector3d(4, 5, 0));
  EXPECT_NEAR((info.pose->rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-12);
  EXPECT_EQ(info.time->count(), 7250000000);
  PointBlock<3> block;
  file->open(0)->read(0, block);
  ASSERT_EQ(block.size, 3u);
  EXPECT_NEAR(block.coordinate[1][0], -1.0, 1e-12);  // the first beam points to the right
  EXPECT_TRUE(std::isnan(block.coordinate[0][1]));   // no return
  EXPECT_NEAR(block.coordinate[1][2], 2.0, 1e-12);
  for (const std::size_t i : {0, 2}) EXPECT_EQ(block.coordinate[2][i], 0.0);
  file->open(0)->read(3, block);
  EXPECT_EQ(block.size, 0u);
}

TEST_F(CarmenScansTest, HaveNoTimesIfTheyDoNotTellSweepsApart) {
  EXPECT_FALSE(open(kThreeBeams + "1.13486e+09 host 1\n" + kThreeBeams + "1.13486e+09 host 2\n")->info(0).time);
  EXPECT_FALSE(open("FLASER 1 1 0 0 0\n")->info(0).time);
  EXPECT_FALSE(open("FLASER 1 1 0 0 0 0 0 0 1e300 host 1\n")->info(0).time);
  EXPECT_EQ(open("FLASER 1 1 0 0 0 0 0 0 3 host 1\n")->info(0).name, "");  // the only scan
}

TEST_F(CarmenScansTest, AreFoundByContentOrName) {
  const std::string text = "# message formats defined: PARAM SYNC\n" + kThreeBeams + "1 host 1\n";
  EXPECT_EQ(open(text, "no_name")->kind(), "CARMEN log");
  EXPECT_EQ(open(test::gzipped(text), "no_name.gz")->kind(), "CARMEN log");
  EXPECT_EQ(open("text before\n" + kThreeBeams, "text.log")->kind(), "CARMEN log");
  EXPECT_TRUE(isCarmenText("\n# x\nROBOTLASER1 0 1"));
  EXPECT_TRUE(isCarmenText("FLASER"));  // cut off
  EXPECT_FALSE(isCarmenText("1 2 3\n4 5 6\n"));
  EXPECT_FALSE(isCarmenText("SYNC\nx y z\n"));
  EXPECT_FALSE(isCarmenText(""));
  EXPECT_EQ(open("1 2 3\n4 5 6\n", "points.log")->kind().find("CARMEN"), std::string::npos);
}

TEST_F(CarmenScansTest, WarnOfDamagedLines) {
  std::string text;
  for (int i = 0; i < 8; ++i) text += "FLASER x\n";
  const std::vector<std::string> warnings = open(text + kThreeBeams + "1 host 1\n")->warnings();
  ASSERT_EQ(warnings.size(), 6u);
  EXPECT_EQ(warnings[0], "line 1 is left out: expected the number of ranges, found 'x'");
  EXPECT_EQ(warnings[5], "3 more lines are left out");
}

TEST_F(CarmenScansTest, RefuseASmallFileThatWouldFillTheMemory) {
  std::string text, line = "FLASER 2000";
  for (int beam = 0; beam < 2000; ++beam) line += " 5";
  line += " 0 0 0\n";
  while (text.size() < (std::size_t{40} << 20)) text += line;
  try {
    open(test::gzipped(text));
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("expands to more than 100 times its size"), std::string::npos);
  }
}

}  // namespace
}  // namespace gaussmap
