// SPDX-License-Identifier: BSD-3-Clause
// gaussmap finish, tiles and pcd2map --max-memory through the real program.
#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

TEST_F(Apps, FinishMakesASmallMapThatSaysThatItIsFinal) {
  const Json said = Json::parse(succeed({"finish", scene("map.gmap"), "-o", own("final.gmap"), "--json"}));
  EXPECT_EQ(said["bytes"], std::filesystem::file_size(own("final.gmap")));
  EXPECT_LT(said["bytes"], said["bytes_before"]);
  EXPECT_NE(said["error"].get<std::string>().find("5 %"), std::string::npos);
  EXPECT_TRUE(sameMap<3>(load(own("final.gmap")), finish<3>(load(scene("map.gmap")))));
  const Json info = infoOf(own("final.gmap"));
  EXPECT_EQ(info["final"], true);
  EXPECT_EQ(info["takes_scans"], false);
  EXPECT_EQ(info["metadata"]["history"].back()["command"], "finish");
  EXPECT_NE(succeed({"info", own("final.gmap")}).find("final (accepts no more scans): means within"),
            std::string::npos);
  EXPECT_EQ(infoOf(scene("map.gmap"))["final"], false);
}

TEST_F(Apps, AFinishedMapIsNotFinishedAgainAndTakesNoScans) {
  succeed({"finish", scene("map.gmap"), "-o", own("final.gmap"), "--finest-scale", "1"});
  EXPECT_EQ(infoOf(own("final.gmap"))["scales"][0]["cells"], 0);
  expectDataError("already final", {"finish", own("final.gmap"), "-o", own("x.gmap")});
  expectDataError("accepts no more scans", {"pcd2map", scene("scans"), "--update", own("final.gmap")});
  expectUsageError("--finest-scale", {"finish", scene("map.gmap"), "-o", own("x.gmap"), "--finest-scale", "3"});
  expectUsageError("destroy the input", {"finish", scene("map.gmap"), "-o", scene("map.gmap"), "--force"});
}

TEST_F(Apps, MaxMemoryGivesTheSameFile) {
  for (const std::string budget : {"1", "2.5"}) {
    const std::vector<std::string> common = {scene("scans"), "--budget", budget, "--no-curves", "--force"};
    const auto build = [&](const std::string& name, std::vector<std::string> words) {
      words.insert(words.end(), common.begin(), common.end());
      succeed(words);
      return contentsOf(own(name));
    };
    const std::string whole = build("whole.gmap", {"pcd2map", "-o", own("whole.gmap")});
    EXPECT_TRUE(build("tiled.gmap", {"pcd2map", "-o", own("tiled.gmap"), "--max-memory", "2M"}) == whole);
  }
}

TEST_F(Apps, MaxMemorySaysWhatItCannotDo) {
  const std::vector<std::string> start = {"pcd2map", scene("scans"), "-o", own("x.gmap"), "--max-memory"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), start.begin(), start.end());
    return more;
  };
  for (const std::string bad : {"0", "x", "-1", "1k", "1000"}) expectUsageError("--max-memory", with({bad}));
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"64M", "--online"},
                                                                                    {"64M", "--method", "insert"},
                                                                                    {"64M", "--max-error", "0.1"},
                                                                                    {"64M", "--max-bytes", "1M"}})
    expectUsageError("--max-memory", with(more));
}

TEST_F(Apps, TilesGoToADirectoryAndBack) {
  const std::string text = succeed({"tiles", scene("map.gmap"), "-o", own("tiles"), "--size", "5"});
  EXPECT_NE(text.find(" tiles of 5 m, "), std::string::npos) << text;
  succeed({"tiles", own("tiles"), "-o", own("back.gmap")});
  const Json before = infoOf(scene("map.gmap")), after = infoOf(own("back.gmap"));
  for (std::size_t s = 0; s < 3; ++s) EXPECT_EQ(after["scales"][s]["cells"], before["scales"][s]["cells"]);
  EXPECT_EQ(after["ratio"], before["ratio"]);
  EXPECT_EQ(after["takes_scans"], false);
  expectDataError("exists already", {"tiles", scene("map.gmap"), "-o", own("tiles")});
  expectUsageError("--scale", {"tiles", scene("map.gmap"), "-o", own("more"), "--scale", "3"});
  expectUsageError("--size", {"tiles", scene("map.gmap"), "-o", own("more"), "--size", "0"});
  expectDataError("does not exist", {"tiles", own("none.gmap"), "-o", own("more")});
  expectDataError("pointcloud_map_metadata.yaml", {"tiles", scene("scans"), "-o", own("x.gmap")});
}

}  // namespace
}  // namespace gaussmap::test
