// SPDX-License-Identifier: BSD-3-Clause
// --min-range, --crop, names of scans and hints about dropped fields through the real program.
#include <fstream>

#include "apps/app_fixture.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/logs/gzip.h"

namespace gaussmap::test {
namespace {

class ScanLimitsApp : public Apps {
 protected:
  /// 100 points at 4 to 8 m and 30 points of the carrier at 0.5 m, sensor at (10, 0, 0).
  std::string carrier() const {
    std::vector<Vector<3>> points;
    for (int i = 0; i < 100; ++i) points.emplace_back(4.02 + 0.04 * i, 0.03 * i - 1.5, -1.01);
    for (int i = 0; i < 30; ++i) points.emplace_back(0.0, 0.5, -0.001 * i);
    writePcd(own("carrier.pcd"), points, PcdPrecision::Float, Pose{{10, 0, 0}, Pose::Rotation::Identity()});
    return own("carrier.pcd");
  }
  static Json countsOf(const std::vector<std::string>& arguments) {
    std::vector<std::string> words = arguments;
    words.push_back("--json");
    return Json::parse(succeed(words))["points"];
  }
};

TEST_F(ScanLimitsApp, MinRangeDropsTheCarrier) {
  const std::string scan = carrier();
  const std::string text = succeed({"pcd2map", scan, "-o", own("a.gmap"), "--min-range", "1"});
  EXPECT_NE(text.find("100 points (left out: 0 not finite, 0 at range 0, 0 too far, 30 too near)"), std::string::npos)
      << text;
  const Json online = countsOf({"pcd2map", scan, "-o", own("b.gmap"), "--min-range", "1", "--online"});
  EXPECT_EQ(online["accepted"], 100);
  EXPECT_EQ(online["too_near"], 30);
  const Json memory = countsOf({"pcd2map", scan, "-o", own("m.gmap"), "--min-range", "1", "--max-memory", "100M"});
  EXPECT_EQ(memory["accepted"], 100);
  EXPECT_EQ(contentsOf(own("m.gmap")).size() > 0, true);
  expectDataError("130 nearer than --min-range", {"pcd2map", scan, "-o", own("c.gmap"), "--min-range", "99"});
  expectUsageError("--min-range", {"pcd2map", scan, "-o", own("c.gmap"), "--min-range", "3", "--max-range", "2"});
}

TEST_F(ScanLimitsApp, MinRangeIsAnOptionOfEveryCommandThatReadsScans) {
  const std::string scan = carrier(), scans = scene("scans").string(), map = scene("map.gmap").string();
  const Json distances = Json::parse(succeed({"hausdorff", scan, scan, "--min-range", "1", "--json"}));
  EXPECT_EQ(distances["all"]["forward"]["count"], 100);
  succeed({"clean", scans, "-o", own("clean"), "--min-range", "0.5"});
  succeed({"register", scene("scans/scan00.pcd").string(), map, "--min-range", "0.5", "--max-range", "50"});
  expectDataError("no usable point", {"register", scene("scans/scan00.pcd").string(), map, "--min-range", "500"});
}

TEST_F(ScanLimitsApp, CropUsesOnlyThePointsInABoxOfTheMapFrame) {
  const std::string scan = carrier();
  // x from 14.02: 25 points below 15; y and z all.
  const Json flat = countsOf({"pcd2map", scan, "-o", own("a.gmap"), "--crop", "14", "-9", "15", "9"});
  EXPECT_EQ(flat["accepted"], 25);
  EXPECT_EQ(flat["outside_crop"], 105);
  const Json none_above = countsOf({"pcd2map", scan, "-o", own("b.gmap"), "--crop", "0", "-9", "-0.5", "99", "9", "9"});
  EXPECT_EQ(none_above["accepted"], 30);
  EXPECT_EQ(countsOf({"pcd2map", scan, "-o", own("o.gmap"), "--online", "--crop", "14", "-9", "15", "9"})["accepted"],
            25);
  for (const std::vector<std::string>& wrong :
       std::vector<std::vector<std::string>>{{"1", "2", "3", "4", "5"}, {"2", "0", "1", "9"}}) {
    std::vector<std::string> words = {"pcd2map", scan, "-o", own("c.gmap"), "--crop"};
    words.insert(words.end(), wrong.begin(), wrong.end());
    expectUsageError("--crop", words);
  }
}

TEST_F(ScanLimitsApp, IntensityAndColourAreToldToBeDropped) {
  directory_.write("i.pcd",
                   "FIELDS x y z Intensity rgb\nSIZE 4 4 4 4 4\nTYPE F F F F F\nPOINTS 1\nDATA ascii\n1 2 3 4 5\n");
  const Outcome said = runApp({"pcd2map", own("i.pcd"), "-o", own("i.gmap")});
  EXPECT_EQ(said.code, 0);
  EXPECT_NE(said.err.find("gaussmap: note: the map keeps only geometry: the fields Intensity and rgb"),
            std::string::npos)
      << said.err;
}

TEST_F(ScanLimitsApp, FoldersTellScansOfTheSameNameApart) {
  for (int i = 0; i < 3; ++i) {
    const std::string folder = own("dump/00000" + std::to_string(i));
    std::filesystem::create_directories(folder);
    std::filesystem::copy(scene("scans/scan0" + std::to_string(i) + ".pcd"), folder + "/cloud.pcd");
  }
  const std::vector<std::string> scans = {own("dump/000000/cloud.pcd"), own("dump/000001/cloud.pcd"),
                                          own("dump/000002/cloud.pcd")};
  std::vector<std::string> words = {"clean", "-o", own("clean")};
  words.insert(words.end(), scans.begin(), scans.end());
  succeed(words);
  for (int i = 0; i < 3; ++i)
    EXPECT_TRUE(std::filesystem::exists(own("clean/00000" + std::to_string(i) + "/cloud.pcd")));
  // The lines are in another order than the scans.
  const std::string by_folder = "000002 2 0 0 0 0 0 1\n000000 0 0 0 0 0 0 1\n000001 1 0 0 0 0 0 1\n",
                    by_path =
                        "000002/cloud.pcd 2 0 0 0 0 0 1\n000000/cloud.pcd 0 0 0 0 0 0 1\n"
                        "000001/cloud.pcd 1 0 0 0 0 0 1\n",
                    in_order = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n";
  std::vector<std::string> maps;
  for (const std::string& text : {in_order, by_folder, by_path}) {
    directory_.write("poses.txt", text);
    maps.push_back(own("m" + std::to_string(maps.size()) + ".gmap"));
    std::vector<std::string> build = {"pcd2map", "-o", maps.back(), "--no-curves", "--poses", own("poses.txt")};
    build.insert(build.end(), scans.begin(), scans.end());
    succeed(build);
  }
  EXPECT_EQ(contentsOf(maps[1]), contentsOf(maps[0]));
  EXPECT_EQ(contentsOf(maps[2]), contentsOf(maps[0]));
  expectDataError("dump/*/cloud.pcd", {"pcd2map", own("dump"), "-o", own("x.gmap")});
}

TEST_F(ScanLimitsApp, GzippedScansAreReadAndCleanedToPlainOnes) {
  std::filesystem::create_directories(own("zip"));
  std::filesystem::create_directories(own("plain"));
  for (int i = 0; i < 2; ++i) {
    const std::string name = "scan0" + std::to_string(i) + ".pcd", bytes = contentsOf(scene("scans/" + name));
    directory_.write("zip/" + name + ".gz", gzipped(bytes));
    directory_.write("plain/" + name, bytes);
  }
  succeed({"pcd2map", own("zip"), "-o", own("a.gmap")});
  succeed({"pcd2map", own("plain"), "-o", own("b.gmap")});
  EXPECT_EQ(contentsOf(own("a.gmap")), contentsOf(own("b.gmap")));
  succeed({"clean", own("zip"), "-o", own("clean")});
  EXPECT_TRUE(std::filesystem::exists(own("clean/scan01.pcd")));
}

TEST_F(ScanLimitsApp, InvalidViewpointsDoNotMatterInTheMapFrame) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT ";
  for (const std::string viewpoint : {"0 0 0 0 0 0 0", "1 2 3 2 0 0 0", "nan 0 0 1 0 0 0"}) {
    directory_.write("v.pcd", head + viewpoint + "\nPOINTS 1\nDATA ascii\n4 5 6\n");
    const Outcome said = runApp({"pcd2map", own("v.pcd"), "-o", own("v.gmap"), "--frame", "map", "--force"});
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_NE(said.err.find("warning: " + own("v.pcd")), std::string::npos) << said.err;
    expectDataError("v.pcd", {"pcd2map", own("v.pcd"), "-o", own("w.gmap")});
  }
}

}  // namespace
}  // namespace gaussmap::test
