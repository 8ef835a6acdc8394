// SPDX-License-Identifier: BSD-3-Clause
// gaussmap pcd2map --update through the real program.
#include <random>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

class UpdateApp : public Apps {
 protected:
  static std::string scan(int i) { return scene("scans") / ("scan0" + std::to_string(i) + ".pcd"); }
  /// A map of the first scans.
  std::string mapOf(int scans, const std::string& budget, const std::string& name = "grown.gmap") const {
    std::vector<std::string> words = {"pcd2map", "-o", own(name), "--budget", budget};
    for (int i = 0; i < scans; ++i) words.push_back(scan(i));
    succeed(words);
    return own(name);
  }
};

TEST_F(UpdateApp, AddsScansAsIfAllHadBeenThereAtOnce) {
  const std::string map = mapOf(3, "1"), all = mapOf(5, "1", "all.gmap");
  const std::string text = succeed({"pcd2map", "--update", map, scan(3)});
  EXPECT_NE(text.find("1 scan, "), std::string::npos) << text;
  EXPECT_NE(text.find(" added, Gaussians per scale "), std::string::npos) << text;
  EXPECT_NE(text.find(" tiles written, "), std::string::npos) << text;
  const Json said = Json::parse(succeed({"pcd2map", "--update", map, scan(4), "--json"}));
  EXPECT_TRUE(sameMap<3>(load(map), load(all)));
  const Json info = infoOf(map);
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_EQ(said["scales"][s]["cells"], info["scales"][s]["cells"]);
    EXPECT_EQ(said["scales"][s]["gaussians"], info["scales"][s]["gaussians"]);
  }
  EXPECT_EQ(said["bytes"], std::filesystem::file_size(map));
  EXPECT_LE(said["tiles_written"], said["tiles"]);
  const Json history = info["metadata"]["history"];
  ASSERT_EQ(history.size(), 3u);
  EXPECT_EQ(history[1]["update"], true);
  EXPECT_EQ(history[2]["points"], said["points"]);
  EXPECT_EQ(history[2]["budget"], 1.0);  // taken over
}

TEST_F(UpdateApp, WritesTilesThatAreLargerThanTheOldFile) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> within(0.0, 3.0);
  std::vector<Vector<3>> points = {{0.5, 0.5, 0.5}};
  writePcd(own("one.pcd"), points);
  for (int i = 0; i < 20000; ++i) points.emplace_back(within(random), within(random), within(random));
  writePcd(own("many.pcd"), {points.begin() + 1, points.end()});
  writePcd(own("all.pcd"), points);
  succeed({"pcd2map", own("one.pcd"), "-o", own("map.gmap"), "--budget", "1"});
  succeed({"pcd2map", own("many.pcd"), "--update", own("map.gmap"), "--no-pose-check"});
  succeed({"pcd2map", own("all.pcd"), "-o", own("all.gmap"), "--budget", "1"});
  EXPECT_TRUE(sameMap<3>(load(own("map.gmap")), load(own("all.gmap"))));
}

TEST_F(UpdateApp, KeepsTheBudgetOfTheMapUnlessAnotherIsGiven) {
  const std::string map = mapOf(3, "2");
  ASSERT_TRUE(infoOf(map)["metadata"].contains("error_curves"));
  succeed({"pcd2map", "--update", map, scan(3)});
  const auto perCell = [&](std::size_t s) {
    const Json scale = infoOf(map)["scales"][s];
    return scale["gaussians"].get<double>() / scale["cells"].get<double>();
  };
  EXPECT_NEAR(perCell(1), 2.0, 0.01);
  EXPECT_FALSE(infoOf(map)["metadata"].contains("error_curves"));  // they told of the old map
  succeed({"pcd2map", "--update", map, scan(4), "--budget", "3", "--cost", "runnalls"});
  EXPECT_GT(perCell(1), 2.5);
  EXPECT_EQ(infoOf(map)["metadata"]["history"].back()["cost"], "runnalls");
  const Outcome again = runApp({"pcd2map", "--update", map, scan(4)});  // warns, because the map has this scan
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(infoOf(map)["metadata"]["history"].back()["cost"], "runnalls");  // taken over too
}

TEST_F(UpdateApp, SaysWhatIsWrongWithItsOptions) {
  const std::string map = mapOf(2, "1"), bytes = contentsOf(map);
  expectUsageError("--output", {"pcd2map", scan(3)});
  expectUsageError("--update", {"pcd2map", scan(3), "--update", map, "-o", own("x.gmap")});
  for (const std::string option : {"--resolution", "--scales", "--ratio", "--noise", "--max-error"})
    expectUsageError(option, {"pcd2map", scan(3), "--update", map, option, "2"});
  expectUsageError("--online", {"pcd2map", scan(3), "--update", map, "--online"});
  EXPECT_EQ(contentsOf(map), bytes);
}

TEST_F(UpdateApp, SaysWhatIsWrongWithItsInputAndLeavesTheMap) {
  expectDataError("does not exist", {"pcd2map", scan(3), "--update", own("none.gmap")});
  expectDataError("is not a map", {"pcd2map", scan(3), "--update", scan(2)});
  const std::string map = mapOf(2, "1"), bytes = contentsOf(map);
  expectDataError("does not exist", {"pcd2map", own("none.pcd"), "--update", map});
  expectDataError("beyond --max-range", {"pcd2map", scan(3), "--update", map, "--max-range", "0.001"});
  EXPECT_EQ(contentsOf(map), bytes);
  succeed({"compress", map, "-o", own("small.gmap"), "--max-error", "0.5"});
  expectDataError("accepts no more scans", {"pcd2map", scan(3), "--update", own("small.gmap")});
}

}  // namespace
}  // namespace gaussmap::test
