// SPDX-License-Identifier: BSD-3-Clause
// gaussmap pcd2map --online and gaussmap restore through the real program.
#include <cmath>
#include <sstream>

#include "apps/app_fixture.h"
#include "apps/passing_post.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "io/gmap/map_equality.h"
#include "io/pcd/removed_pcd.h"

namespace gaussmap::test {
using namespace detail;

namespace {

class OnlineApp : public AppTest {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<TemporaryDirectory>();
    writePostScans(*scene_, "scans");
    ASSERT_EQ(runApp(online("map.gmap",
                            {"--refine-every", "4", "--removed", scene("removed.pcd"), "--stats", scene("stats.csv")}))
                  .code,
              0);
    ASSERT_EQ(runApp(online("keep.gmap", {"--keep"})).code, 0);
  }
  static void TearDownTestSuite() { scene_.reset(); }

  static std::string scene(const std::string& name) { return (scene_->path() / name).string(); }
  /// pcd2map --online of the scene to a file of the scene.
  static std::vector<std::string> online(const std::string& name, const std::vector<std::string>& more) {
    return onlineTo(scene(name), more);
  }
  static std::vector<std::string> onlineTo(const std::string& path, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"pcd2map", "--online", scene("scans"), "-o", path, "--resolution", "0.2"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  static std::size_t deletedFinest() {
    std::size_t finest = 0;
    for (const RemovedCluster<3>& one : readRemoved(scene("removed.pcd"))) finest += one.scale == 0;
    return finest;
  }
  /// The same sums in the same cells; not the same occupancy.
  static bool sameFinest(const std::string& one, const std::string& other) {
    const GaussianMapOctree a = load(one), b = load(other);
    return a.scale(0).keys == b.scale(0).keys && a.scale(0).moments == b.scale(0).moments;
  }

 private:
  static inline std::unique_ptr<TemporaryDirectory> scene_;
};

TEST_F(OnlineApp, MakesAMapThatEveryCommandReads) {
  const Json info = infoOf(scene("map.gmap")), keep = infoOf(scene("keep.gmap"));
  EXPECT_EQ(info["takes_scans"], true);
  EXPECT_EQ(info["compressed"], false);
  EXPECT_EQ(info["occupancy"], true);
  EXPECT_EQ(info["scales"].size(), 3u);
  EXPECT_LT(info["scales"][0]["weight"], keep["scales"][0]["weight"]);
  EXPECT_EQ(keep["scales"][0]["weight"], 69120.0);
  const Json& step = info["metadata"]["history"].back();
  EXPECT_EQ(step["command"], "pcd2map");
  EXPECT_EQ(step["online"], true);
  EXPECT_EQ(step["deleted"].get<std::size_t>(), readRemoved(scene("removed.pcd")).size());
}

TEST_F(OnlineApp, KeepsTheFinestScaleOfAMapBuiltAtOnce) {
  succeed({"pcd2map", scene("scans"), "-o", own("at_once.gmap"), "--resolution", "0.2"});
  EXPECT_TRUE(sameFinest(scene("keep.gmap"), own("at_once.gmap")));
}

TEST_F(OnlineApp, SaysWhatEachScanDid) {
  std::istringstream table(contentsOf(scene("stats.csv")));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line.find("scan,file,points,cells_touched,"), 0u) << line;
  const auto commas = std::count(line.begin(), line.end(), ',');
  int scans = 0;
  for (; std::getline(table, line); ++scans) {
    EXPECT_EQ(line.find(std::to_string(scans) + ",\"scan" + std::to_string(scans) + ".pcd\",8640,"), 0u) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
  }
  EXPECT_EQ(scans, 8);
}

TEST_F(OnlineApp, GivesBackWhatItHasForgotten) {
  ASSERT_GT(deletedFinest(), 10u);
  EXPECT_FALSE(sameFinest(scene("map.gmap"), scene("keep.gmap")));
  const Json said =
      Json::parse(succeed({"restore", scene("map.gmap"), scene("removed.pcd"), "-o", own("whole.gmap"), "--json"}));
  EXPECT_TRUE(sameFinest(own("whole.gmap"), scene("keep.gmap")));
  const GaussianMapOctree forgot = load(scene("map.gmap")), got = load(own("whole.gmap"));
  for (std::size_t cell = 0; cell < got.cellCount(0); ++cell) {
    const auto kept = forgot.find(got.scale(0).keys[cell], 0);
    if (!kept || forgot.scale(0).moments[*kept] != got.scale(0).moments[cell])
      EXPECT_EQ(got.logOdds(cell, 0), kMaxOccupancy);
    else
      EXPECT_EQ(got.logOdds(cell, 0), forgot.logOdds(*kept, 0));
  }
  EXPECT_EQ(said["clusters"].get<std::size_t>(), deletedFinest());
  const Json before = infoOf(scene("map.gmap")), whole = infoOf(own("whole.gmap"));
  EXPECT_EQ(said["points"].get<double>(), 69120.0 - before["scales"][0]["weight"].get<double>());
  for (std::size_t s = 0; s < 3; ++s) EXPECT_EQ(whole["scales"][s]["weight"], 69120.0);
  for (std::size_t s = 1; s < 3; ++s) {
    EXPECT_GE(whole["scales"][s]["gaussians"], before["scales"][s]["gaussians"]);
    EXPECT_GE(whole["scales"][s]["gaussians"], whole["scales"][s]["cells"]);
  }
  EXPECT_EQ(whole["takes_scans"], true);
  const Json& history = whole["metadata"]["history"];
  EXPECT_EQ(history.size(), 2u);
  EXPECT_EQ(history.back()["command"], "restore");
  EXPECT_EQ(history.back()["clusters"].get<std::size_t>(), deletedFinest());
}

TEST_F(OnlineApp, GivesARefinedMapAsManyGaussiansBack) {
  succeed({"refine", scene("map.gmap"), "-o", own("fine.gmap"), "--budget", "4"});
  ASSERT_TRUE(infoOf(own("fine.gmap"))["metadata"].contains("error_curves"));
  const std::string said = succeed({"restore", own("fine.gmap"), scene("removed.pcd"), "-o", own("whole.gmap")});
  EXPECT_NE(said.find("whole.gmap: " + std::to_string(deletedFinest()) + " clusters of "), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1);
  const Json fine = infoOf(own("fine.gmap")), whole = infoOf(own("whole.gmap"));
  for (std::size_t s = 1; s < 3; ++s) {
    EXPECT_GT(fine["scales"][s]["gaussians"], fine["scales"][s]["cells"]);
    EXPECT_EQ(whole["scales"][s]["gaussians"], fine["scales"][s]["gaussians"]);
  }
  EXPECT_FALSE(whole["metadata"].contains("error_curves"));  // of the map as it was
}

TEST_F(OnlineApp, GivesBackWhatLiesInABox) {
  // The post stands at (5, 0): its halves of either side of y = 0 make up the whole.
  const auto restored = [&](const std::string& name, const std::vector<std::string>& box) {
    std::vector<std::string> words = {"restore", scene("map.gmap"), scene("removed.pcd"), "-o", own(name), "--json",
                                      "--box"};
    words.insert(words.end(), box.begin(), box.end());
    return Json::parse(succeed(words));
  };
  const Json left = restored("left.gmap", {"-100", "-100", "-100", "100", "-1e-9", "100"});
  const Json right = restored("right.gmap", {"-100", "0", "-100", "100", "100", "100"});
  EXPECT_GT(left["clusters"], 0);
  EXPECT_GT(right["clusters"], 0);
  EXPECT_EQ(left["clusters"].get<std::size_t>() + right["clusters"].get<std::size_t>(), deletedFinest());
  EXPECT_EQ(infoOf(own("left.gmap"))["metadata"]["history"].back()["box"][4], -1e-9);
  EXPECT_EQ(restored("none.gmap", {"50", "50", "50", "60", "60", "60"})["clusters"], 0);
  EXPECT_TRUE(sameFinest(own("none.gmap"), scene("map.gmap")));
  succeed({"restore", own("left.gmap"), scene("removed.pcd"), "-o", own("both.gmap"), "--box", "-100", "0", "-100",
           "100", "100", "100"});
  EXPECT_TRUE(sameFinest(own("both.gmap"), scene("keep.gmap")));
}

TEST_F(OnlineApp, WritesTheSameBytesOnAnyNumberOfThreads) {
  for (const std::string threads : {"1", "2"}) {
    succeed(onlineTo(own(threads + ".gmap"),
                     {"--threads", threads, "--refine-every", "3", "--removed", own(threads + ".pcd")}));
    succeed({"restore", own(threads + ".gmap"), own(threads + ".pcd"), "-o", own("r" + threads + ".gmap"), "--threads",
             threads});
  }
  EXPECT_EQ(contentsOf(own("1.gmap")), contentsOf(own("2.gmap")));
  EXPECT_EQ(contentsOf(own("1.pcd")), contentsOf(own("2.pcd")));
  EXPECT_EQ(contentsOf(own("r1.gmap")), contentsOf(own("r2.gmap")));
}

TEST_F(OnlineApp, WorksAsInThePaper) {
  const std::string paper = own("paper.gmap");
  std::vector<std::string> words = {"pcd2map", scene("scans"), "-o", paper, "--online", "--as-in-paper"};
  succeed(words);
  const Json info = infoOf(paper);
  EXPECT_EQ(info["takes_scans"], false);
  EXPECT_EQ(info["resolution"], 0.1);
  EXPECT_EQ(info["ratio"], 10);
  EXPECT_EQ(info["scales"].size(), 3u);
  EXPECT_EQ(info["metadata"]["history"].back()["as_in_paper"], true);
  EXPECT_FALSE(infoOf(scene("map.gmap"))["metadata"]["history"].back().contains("as_in_paper"));
  // The map is that of the preset in C++, apart from the noise floor and the budget, which have their defaults in both.
  OnlineMapper<3> mapper(OnlineOptions::yguel2009(3));
  const FoundScans found = findScans({scene("scans")});
  for (std::size_t i = 0; i < found.scans.size(); ++i) mapper.add(found.scans.read(i));
  EXPECT_TRUE(sameMap(load(paper), mapper.map()));
}

TEST_F(OnlineApp, OptionsThatAreGivenOverrideThePaper) {
  const std::string exact = own("exact.gmap"), coarse = own("coarse.gmap");
  succeed({"pcd2map", "--learning-rate", "sample-mean", scene("scans"), "-o", exact, "--online", "--as-in-paper"});
  EXPECT_EQ(infoOf(exact)["takes_scans"], true);
  succeed(
      {"pcd2map", scene("scans"), "-o", coarse, "--as-in-paper", "--online", "--resolution", "0.4", "--ratio", "4"});
  EXPECT_EQ(infoOf(coarse)["resolution"], 0.4);
  EXPECT_EQ(infoOf(coarse)["ratio"], 4);
  EXPECT_EQ(infoOf(coarse)["takes_scans"], false);
  expectUsageError("--online", {"pcd2map", scene("scans"), "-o", own("x.gmap"), "--as-in-paper"});
}

TEST_F(OnlineApp, WorksAsInThePaperOnSimulatedDrives) {
  succeed(
      {"simulate", "street", "--moving", "--scans", "10", "--rings", "16", "--columns", "240", "-o", own("street")});
  succeed({"simulate", "plan", "--scans", "20", "--columns", "181", "-o", own("plan")});
  for (const std::string threads : {"1", "2"}) {
    succeed({"pcd2map", own("street") + "/scans", "-o", own("street" + threads + ".gmap"), "--online", "--as-in-paper",
             "--stats", own("street" + threads + ".csv"), "--threads", threads});
    succeed({"pcd2map", own("plan") + "/scans", "-o", own("plan" + threads + ".gmap"), "--planar", "--online",
             "--as-in-paper", "--threads", threads});
  }
  EXPECT_EQ(contentsOf(own("street1.gmap")), contentsOf(own("street2.gmap")));
  succeed({"pcd2map", own("street") + "/scans", "-o", own("parent.gmap"), "--online", "--as-in-paper", "--seed-rule",
           "parent"});
  EXPECT_FALSE(sameMap(load(own("street1.gmap")), load(own("parent.gmap"))));
  EXPECT_EQ(contentsOf(own("plan1.gmap")), contentsOf(own("plan2.gmap")));
  const Json street = infoOf(own("street1.gmap")), plan = infoOf(own("plan1.gmap"));
  EXPECT_EQ(street["resolution"], 0.1);
  EXPECT_EQ(plan["resolution"], 0.05);
  for (const Json& info : {street, plan}) {
    EXPECT_EQ(info["metadata"]["history"].back()["as_in_paper"], true);
    // One refinement every ten scans, with four clusters for each of the two coarse scales.
    const std::size_t refinements = info == plan ? 2 : 1;
    for (std::size_t s = 1; s < 3; ++s) {
      const auto gaussians = info["scales"][s]["gaussians"].get<std::size_t>();
      const auto cells = info["scales"][s]["cells"].get<std::size_t>();
      EXPECT_GT(gaussians, cells);
      EXPECT_LE(gaussians, cells + 4 * refinements);
    }
  }
}

TEST_F(OnlineApp, EveryConstantChangesTheMap) {
  const std::vector<std::string> paper = {"pcd2map",       scene("scans"), "--online",
                                          "--as-in-paper", "--resolution", "0.2"};
  const std::vector<std::vector<std::string>> constants = {
      {"--slowest-rate", "0.01"}, {"--fastest-rate", "0.1"}, {"--max-log-odds", "2"},
      {"--forget-below", "-1"},   {"--max-samples", "2"},    {"--hit", "0.5"},
      {"--miss", "0.3"},          {"--tolerance", "1"},      {"--clearance", "2"}};
  const auto bytesWith = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), {"-o", own("one.gmap"), "--force"});
    words.insert(words.end(), more.begin(), more.end());
    succeed(words);
    return load(own("one.gmap"));
  };
  const GaussianMapOctree as_in_paper = bytesWith(paper, {});
  for (const std::vector<std::string>& constant : constants)
    EXPECT_FALSE(sameMap(as_in_paper, bytesWith(paper, constant))) << constant[0];
  // What the object hid lies on the far side of the room: it takes both a long link and a long reach to get there.
  const auto removed = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = onlineTo(own("usual.gmap"), {"--force", "--removed", own("usual.pcd")});
    words.insert(words.end(), more.begin(), more.end());
    succeed(words);
    return readRemoved(own("usual.pcd")).size();
  };
  const std::size_t by_default = removed({});
  EXPECT_EQ(removed({"--link", "0.2", "--reach", "0.5", "--tolerance", "0.3", "--clearance", "0.35"}), by_default);
  EXPECT_EQ(removed({"--link", "2"}), by_default);
  EXPECT_EQ(removed({"--reach", "4"}), by_default);
  EXPECT_GT(removed({"--link", "2", "--reach", "4"}), by_default);
}

TEST_F(OnlineApp, OnlyTheLongHelpNamesTheConstants) {
  const std::vector<std::string> names = {"--slowest-rate", "--fastest-rate", "--max-log-odds", "--forget-below",
                                          "--max-samples",  "--hit",          "--miss",         "--tolerance",
                                          "--clearance",    "--link",         "--reach",        "--as-in-paper"};
  const std::string brief = succeed({"pcd2map", "--help"}), all = succeed({"pcd2map", "--help-all"});
  for (const std::string& name : names) {
    EXPECT_EQ(brief.find(name), std::string::npos) << name;
    EXPECT_NE(all.find(name), std::string::npos) << name;
  }
}

TEST_F(OnlineApp, LearnsByOccupancyButCannotGiveThatBack) {
  succeed(onlineTo(own("map.gmap"), {"--learning-rate", "occupancy", "--removed", own("removed.pcd")}));
  EXPECT_EQ(infoOf(own("map.gmap"))["takes_scans"], false);
  EXPECT_FALSE(readRemoved(own("removed.pcd")).empty());
  expectDataError("Gaussians only", {"restore", own("map.gmap"), scene("removed.pcd"), "-o", own("x.gmap")});
  expectDataError("has no moments: it was deleted",
                  {"restore", scene("map.gmap"), own("removed.pcd"), "-o", own("x.gmap")});
}

TEST_F(OnlineApp, RestoresOnlyWhatFitsTheMap) {
  const std::string removed = scene("removed.pcd"), out = own("x.gmap");
  succeed({"pcd2map", scene("scans"), "-o", own("finer.gmap"), "--resolution", "0.1", "--budget", "1"});
  expectDataError("another resolution", {"restore", own("finer.gmap"), removed, "-o", out});
  succeed({"compress", scene("map.gmap"), "-o", own("small.gmap"), "--max-error", "1"});
  expectDataError("is compressed", {"restore", own("small.gmap"), removed, "-o", out});
  expectDataError("is not a cloud of deleted clusters",
                  {"restore", scene("map.gmap"), scene("scans") + "/scan0.pcd", "-o", out});
  expectDataError("does not exist", {"restore", own("none.gmap"), removed, "-o", out});
  std::vector<RemovedCluster<3>> clusters = readRemoved(removed);
  clusters.front().gaussian.mean.x() += 0.05;
  writeRemoved(own("moved.pcd"), clusters);
  expectDataError("does not lie in this cell", {"restore", scene("map.gmap"), own("moved.pcd"), "-o", out});
  clusters.assign(1, readRemoved(removed).front());
  clusters[0].moments.count = (std::int64_t{1} << 33) - 1;
  clusters[0].moments.sum = {};
  clusters[0].gaussian.mean = Grid<3>({0.2}).centre(clusters[0].key, 0);
  writeRemoved(own("many.pcd"), clusters);
  expectDataError("too many points", {"restore", scene("map.gmap"), own("many.pcd"), "-o", out});
}

TEST_F(OnlineApp, SaysWhatIsWrongWithTheOptionsOfRestore) {
  const std::string map = scene("map.gmap"), removed = scene("removed.pcd"), out = own("x.gmap");
  expectUsageError("--output", {"restore", map, removed});
  expectUsageError("removed", {"restore", map, "-o", out});
  expectUsageError("first corner", {"restore", map, removed, "-o", out, "--box", "1", "0", "0", "0", "9", "9"});
  expectUsageError("--box", {"restore", map, removed, "-o", out, "--box", "0", "0", "0", "9", "9"});
  expectUsageError("not in the range", {"restore", map, removed, "-o", out, "--box", "0", "0", "nan", "9", "9", "9"});
  expectUsageError("destroy the input", {"restore", map, removed, "-o", map, "--force"});
  expectUsageError("destroy the input", {"restore", map, removed, "-o", removed, "--force"});
  succeed({"restore", map, removed, "-o", out});
  expectUsageError("exists already", {"restore", map, removed, "-o", out});
  succeed({"restore", map, removed, "-o", out, "--force"});
}

TEST_F(OnlineApp, SaysWhatIsWrongWithItsOptions) {
  const std::string out = own("x.gmap"), file = own("file");
  const std::vector<std::vector<std::string>> without = {{"--learning-rate", "occupancy"},
                                                         {"--occupancy-every", "2"},
                                                         {"--occupancy-samples", "mean"},
                                                         {"--look-back", "3"},
                                                         {"--keep"},
                                                         {"--no-return-is-free", "5"},
                                                         {"--max-ranges", "5"},
                                                         {"--refine-every", "2"},
                                                         {"--refine-cells", "2"},
                                                         {"--as-in-paper"},
                                                         {"--slowest-rate", "0.001"},
                                                         {"--fastest-rate", "0.1"},
                                                         {"--max-log-odds", "5"},
                                                         {"--forget-below", "1"},
                                                         {"--max-samples", "5"},
                                                         {"--hit", "1"},
                                                         {"--miss", "1"},
                                                         {"--tolerance", "1"},
                                                         {"--clearance", "1"},
                                                         {"--link", "1"},
                                                         {"--reach", "1"},
                                                         {"--stats", file},
                                                         {"--removed", file}};
  for (const std::vector<std::string>& option : without) {
    std::vector<std::string> words = {"pcd2map", scene("scans"), "-o", out};
    words.insert(words.end(), option.begin(), option.end());
    expectUsageError("--online", words);
  }
  const std::vector<std::vector<std::string>> bad = {{"--learning-rate", "fast"},
                                                     {"--occupancy-every", "0"},
                                                     {"--occupancy-samples", "all"},
                                                     {"--look-back", "-1"},
                                                     {"--no-return-is-free", "0"},
                                                     {"--no-return-is-free", "nan"},
                                                     {"--max-ranges", "5,-1"},
                                                     {"--refine-every", "-1"},
                                                     {"--refine-cells", "-1"},
                                                     {"--slowest-rate", "0"},
                                                     {"--slowest-rate", "0.06"},
                                                     {"--fastest-rate", "2"},
                                                     {"--max-log-odds", "0"},
                                                     {"--max-log-odds", "11"},
                                                     {"--forget-below", "nan"},
                                                     {"--forget-below", "-11"},
                                                     {"--max-samples", "-1"},
                                                     {"--hit", "0"},
                                                     {"--miss", "-1"},
                                                     {"--tolerance", "-1"},
                                                     {"--clearance", "nan"},
                                                     {"--link", "201"},
                                                     {"--reach", "-0.1"}};
  for (const std::vector<std::string>& option : bad) expectUsageError(option[0], onlineTo(out, option));
  expectUsageError("--forget-below", onlineTo(out, {"--max-log-odds", "2", "--forget-below", "-2.5"}));
  for (const std::vector<std::string>& limit : std::vector<std::vector<std::string>>{
           {"--max-gaussians", "100000"}, {"--max-bytes", "1M"}, {"--max-error", "1"}, {"--cost", "runnalls"}})
    expectUsageError("--online", onlineTo(out, limit));
}

TEST_F(OnlineApp, NeverWritesOneFileOverAnother) {
  const std::string out = own("x.gmap");
  expectUsageError("another output", onlineTo(out, {"--stats", out}));
  expectUsageError("another output", onlineTo(out, {"--stats", own("a"), "--removed", own("./a")}));
  expectUsageError("destroy the input", onlineTo(out, {"--removed", scene("scans") + "/scan0.pcd", "--force"}));
  directory_.write("a", "mine");
  expectUsageError("exists already", onlineTo(out, {"--stats", own("a")}));
  expectUsageError("exists already", onlineTo(out, {"--removed", own("a")}));
  succeed(onlineTo(out, {"--stats", own("a"), "--force"}));
  EXPECT_NE(contentsOf(own("a")), "mine");
}

TEST_F(OnlineApp, WritesNothingWithoutPoints) {
  const std::string none = directory_.write("none.pcd", xyzHeader(1, "ascii") + "nan nan nan\n").string();
  expectDataError("points is usable", {"pcd2map", "--online", none, "-o", own("x.gmap"), "--stats", own("s.csv"),
                                       "--removed", own("r.pcd")});
}

TEST_F(OnlineApp, LeavesOutWhatIsTooFar) {
  const Json said = Json::parse(succeed(onlineTo(own("near.gmap"), {"--max-range", "8", "--keep", "--json"})));
  const Json& points = said["points"];
  EXPECT_EQ(points["read"], 69120);
  EXPECT_GT(points["beyond_range"], 10000);
  EXPECT_EQ(points["accepted"].get<int>() + points["beyond_range"].get<int>(), 69120);
  EXPECT_EQ(infoOf(own("near.gmap"))["scales"][0]["weight"], points["accepted"].get<double>());
}

}  // namespace
}  // namespace gaussmap::test
