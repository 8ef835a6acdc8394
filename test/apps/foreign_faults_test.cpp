// SPDX-License-Identifier: BSD-3-Clause
// The real program far from home: another language, names from anywhere, more files than anybody wanted.
#include <sys/resource.h>

#include <cstdlib>
#include <map>
#include <regex>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/mapping/build.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

using Foreign = Apps;

TEST_F(Foreign, LanguagesChangeNothing) {  // a German writes 0,5 and 1.000
  const std::string locales = own("locales"), german = locales + "/de_DE.UTF-8";
  fs::create_directory(locales);
  if (std::system(("localedef -i de_DE -f UTF-8 '" + german + "' > /dev/null 2>&1").c_str()) != 0)
    GTEST_SKIP() << "localedef cannot make a German locale here";
  const auto in_german = [locales] {
    ::setenv("LOCPATH", locales.c_str(), 1);
    ::setenv("LC_ALL", "de_DE.UTF-8", 1);
    ::setenv("LANG", "de_DE.UTF-8", 1);
  };
  const std::string map = own("a.gmap"), scans = scene("scans"), floor = own("plan");
  const std::vector<std::vector<std::string>> commands = {
      {"simulate", "plan", "-o", floor, "--scans", "40", "--columns", "90", "--noise", "0.015", "--force"},
      {"pcd2map", scans, "-o", map, "--resolution", "0.25", "--ratio", "4", "--budget", "2.5", "--force"},
      {"info", map},
      {"info", map, "--json"},
      {"export", map, own("a.pcd"), "--force"},
      {"tiles", map, "-o", own("tiles"), "--force"},
      {"transform", map, "-o", own("b.gmap"), "--transform", "1.5 0 0.25 0 0 0 1", "--force"},
      {"diff", map, own("b.gmap"), "-o", own("diff.pcd"), "--force"},
      {"hausdorff", map, scene("truth.pcd"), "--frame", "map", "--samples", "1000"},
      {"draw", map, "-o", own("a.svg"), "--force"},
      {"segments", floor + "/scans", "-o", own("a.csv"), "-o", own("a.geojson"), "-o", own("a.svg"), "-o", own("s.pcd"),
       "--stats", own("stats.csv"), "--force"},
      {"pcd2map", scans, "-o", own("x.gmap"), "--poses", floor + "/trajectory.tum"},
      {"pcd2map", scans, "-o", own("x.gmap"), "--resolution", "0,25"}};
  std::vector<std::pair<std::string, std::string>> said[2];
  std::map<std::string, std::string> written[2];
  for (const bool german_now : {false, true}) {
    for (const std::vector<std::string>& command : commands) {
      const Outcome outcome = runApp(command, "", german_now ? std::function<void()>(in_german) : nullptr);
      // Everything but how long it took.
      const std::string out = std::regex_replace(outcome.out, std::regex("[0-9.]+ (s\n|beams/s)"), "");
      said[german_now].emplace_back(out, outcome.err);
    }
    for (const std::string& name : ownFiles())
      if (name.rfind("locales", 0) != 0 && fs::is_regular_file(own(name)))
        written[german_now][name] = contentsOf(own(name));
    if (!german_now) fs::remove_all(own("tiles"));
  }
  EXPECT_EQ(said[0], said[1]);
  ASSERT_EQ(written[0].size(), written[1].size());
  for (const auto& [name, bytes] : written[0]) EXPECT_TRUE(written[1].at(name) == bytes) << name;
  EXPECT_GT(written[0].size(), 50u);
}

TEST_F(Foreign, NamesAreOnlyNames) {
  for (const std::string name : {"Straße und Ölberg", "道路 地図", "a 'b' \"c\" $d;e", " x ", "%41?immutable=0#f", "-o",
                                 "naïve\xFF\xFE", "two\nlines", ":memory:"}) {
    const fs::path folder = directory_.path() / ("in " + name);
    fs::create_directories(folder / "scans");
    for (const auto& scan : fs::directory_iterator(scene("scans")))
      fs::copy_file(scan.path(), folder / "scans" / (name + scan.path().filename().string()));
    const std::string map = folder / (name + ".gmap"), cloud = folder / (name + ".pcd"),
                      one = folder / (name + "1.gmap");
    succeed({"pcd2map", folder / "scans", "-o", map, "--budget", "1"});
    expectSameMap<3>(load(map), load(scene("map.gmap")));
    succeed({"pcd2map", folder / "scans" / (name + "scan00.pcd"), "-o", one, "--budget", "1", "--max-memory", "20M"});
    for (const char* const scan : {"scan01.pcd", "scan02.pcd", "scan03.pcd", "scan04.pcd"})
      succeed({"pcd2map", folder / "scans" / (name + scan), "--update", one});
    expectSameMap<3>(load(one), load(map));
    succeed({"export", map, cloud});
    EXPECT_EQ(contentsOf(cloud), contentsOf(scene("map.pcd")));
    succeed({"draw", map, "-o", folder / (name + ".svg")});
    EXPECT_EQ(infoOf(map)["scales"][0]["cells"], infoOf(scene("map.gmap"))["scales"][0]["cells"]);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 5) << name;  // scans, two maps, cloud, picture
    expectDataError(own("in "), {"pcd2map", folder / "none.pcd", "-o", own("x.gmap")});
  }
}

TEST_F(Foreign, TenThousandFilesAreAnOrdinaryCall) {
  constexpr int kFiles = 10000;
  std::vector<std::string> arguments = {"pcd2map", "-o", own("all.gmap"), "--budget", "1"};
  std::vector<Vector<3>> points;
  fs::create_directory(own("scans"));
  for (int i = 0; i < kFiles; ++i) {
    const Vector<3> point(0.25 * (i % 100) + 0.125, 0.25 * (i / 100) + 0.125, 0.5);
    points.push_back(point);
    arguments.push_back(directory_.write(
        "scans/" + std::to_string(i) + ".pcd",
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\n"
        "DATA ascii\n" +
            std::to_string(point.x()) + " " + std::to_string(point.y()) + " 0.5\n"));
  }
  const auto few_descriptors = [] {
    const struct rlimit limit { 64, 64 };
    if (::setrlimit(RLIMIT_NOFILE, &limit) != 0) ::_exit(125);
  };
  const Outcome outcome = runApp(arguments, "", few_descriptors);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("10000 scans, 10000 points"), std::string::npos) << outcome.out;
  expectSameMap<3>(load(own("all.gmap")), build<3>(points, MapOptions()));
  const Outcome folder =
      runApp({"pcd2map", own("scans"), "-o", own("folder.gmap"), "--budget", "1"}, "", few_descriptors);
  EXPECT_EQ(folder.code, 0) << folder.err;
  expectSameMap<3>(load(own("folder.gmap")), load(own("all.gmap")));
}

}  // namespace
}  // namespace gaussmap::test
