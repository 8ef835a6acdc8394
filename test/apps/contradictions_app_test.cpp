// SPDX-License-Identifier: BSD-3-Clause
// Inputs and outputs that do not fit each other: the program says so and what to do.
#include "apps/app_fixture.h"
#include "gaussmap/io/export/map_tiles.h"
#include "gaussmap/io/pcd/pcd_writer.h"

namespace gaussmap::test {
namespace {

class ContradictionsApp : public Apps {
 protected:
  static std::string said(const std::vector<std::string>& arguments) {
    const Outcome outcome = runApp(arguments);
    EXPECT_EQ(outcome.code, 0) << testing::PrintToString(arguments) << outcome.err;
    return outcome.err;
  }
  static std::string scan(int i) { return scene("scans/scan0" + std::to_string(i) + ".pcd").string(); }
  std::string mapOf(const std::string& name, const std::vector<std::string>& scans) const {
    std::vector<std::string> words = {"pcd2map", "-o", own(name), "--budget", "1"};
    words.insert(words.end(), scans.begin(), scans.end());
    succeed(words);
    return own(name);
  }
};

TEST_F(ContradictionsApp, EndingsInCapitalsAreEndings) {
  const std::string map = scene("map.gmap").string();
  for (const std::string name : {"a.PCD", "a.Ply", "a.VTP", "a.CSV"}) succeed({"export", map, own(name)});
  EXPECT_EQ(infoOf(own("a.PCD"))["scales"].size(), 3u);
  succeed({"draw", map, "-o", own("a.SVG")});
  std::filesystem::copy(map, own("B.GMAP"));
  EXPECT_EQ(infoOf(own("B.GMAP"))["scales"].size(), 3u);
  expectUsageError(".pcd", {"pcd2map", scan(0), "-o", own("c.PCD")});
}

TEST_F(ContradictionsApp, OutputsMustNotHaveTheEndingOfAnotherKind) {
  const std::string map = scene("map.gmap").string(), scans = scene("scans").string();
  for (const std::string name : {"a.ply", "a.csv", "a.SVG", "a.txt", "a.las"})
    expectUsageError("this output is a map", {"pcd2map", scans, "-o", own(name)});
  expectUsageError("this output is a map", {"crop", map, "-o", own("a.ply"), "--box", "-1", "-1", "1", "1"});
  expectUsageError("PCD file", {"clean", scans, "--merged", own("a.ply")});
  expectUsageError("PCD file", {"clean", scans, "--removed", own("a.csv")});
  expectUsageError("--merged", {"clean", scans, "-o", own("a.pcd")});
  expectUsageError("table", {"pcd2map", scans, "-o", own("a.gmap"), "--online", "--stats", own("a.pcd")});
  expectUsageError("poses", {"register", scan(0), map, "--tum", own("a.pcd")});
  succeed({"pcd2map", scans, "-o", own("no_ending")});
}

TEST_F(ContradictionsApp, MapsThatDoNotOverlapAreReportedByDiff) {
  const std::string map = scene("map.gmap").string();
  succeed({"transform", map, "-o", own("far.gmap"), "--transform", "500 0 0 0 0 0 1"});
  const std::string text = said({"diff", map, own("far.gmap")});
  EXPECT_NE(text.find("do not overlap"), std::string::npos) << text;
  EXPECT_NE(text.find("same frame?"), std::string::npos) << text;
  EXPECT_EQ(said({"diff", map, map}), "");
}

TEST_F(ContradictionsApp, UpdateWarnsOfScansThatAreFarAway) {
  const std::string map = mapOf("m.gmap", {scan(0), scan(1)});
  writePcd(own("far.pcd"), std::vector<Vector<3>>{{1, 2, 0}, {2, 2, 0}}, PcdPrecision::Float,
           Pose{{0, 7000, 0}, Pose::Rotation::Identity()});
  const std::string text = said({"pcd2map", "--update", map, scan(2), own("far.pcd")});
  EXPECT_NE(text.find("far.pcd: no point lies near the map"), std::string::npos) << text;
}

TEST_F(ContradictionsApp, UpdateWarnsOfScansThatAreInTheMap) {
  const std::string map = mapOf("m.gmap", {scan(0), scan(1), scan(2)});
  EXPECT_EQ(said({"pcd2map", "--update", map, scan(3)}), "");
  for (int times = 0; times < 2; ++times) {
    const std::string text = said({"pcd2map", "--update", map, scan(1)});
    EXPECT_NE(text.find("already in"), std::string::npos) << text;
  }
}

TEST_F(ContradictionsApp, TilesOfPointsNameTheCommandForPoints) {
  std::filesystem::create_directories(own("tiles"));
  writePcd(own("tiles/0_0.pcd"), std::vector<Vector<3>>{{1, 2, 3}});
  expectDataError("gaussmap pcd2map", {"tiles", own("tiles"), "-o", own("a.gmap")});
  directory_.write("tiles/" + std::string(kTilesIndex), "x_resolution: 20\ny_resolution: 20\n0_0.pcd: [0, 0]\n");
  expectDataError("gaussmap pcd2map " + own("tiles") + " --frame map", {"tiles", own("tiles"), "-o", own("a.gmap")});
  expectDataError("gaussmap pcd2map", {"info", own("tiles/0_0.pcd")});
  succeed({"tiles", scene("map.gmap"), "-o", own("good")});
  expectDataError("gaussmap tiles DIR", {"pcd2map", own("good"), "-o", own("a.gmap")});
}

}  // namespace
}  // namespace gaussmap::test
