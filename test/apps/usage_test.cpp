// SPDX-License-Identifier: BSD-3-Clause
// Help, and wrong usage: exit code 2.
#include <sstream>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kCommands = {
    "pcd2map", "scans", "refine", "compress", "register", "finish", "tiles",     "simplify", "merge", "transform",
    "crop",    "diff",  "clean",  "restore",  "info",     "export", "hausdorff", "simulate", "draw",  "segments"};

TEST_F(Apps, ExplainThemselvesWithAnExample) {
  for (const std::string& command : kCommands) {
    const std::string help = succeed({command, "--help"});
    EXPECT_NE(help.find("Example: gaussmap " + command), std::string::npos) << help;
    EXPECT_EQ(succeed({command, "-h"}), help);
  }
  const std::string help = succeed({"--help"});
  EXPECT_NE(help.find("Example: gaussmap "), std::string::npos);
  for (const std::string& command : kCommands) EXPECT_NE(help.find("\n  " + command + " "), std::string::npos) << help;
  EXPECT_EQ(succeed({"--version"}).find("gaussmap 0."), 0u);
}

TEST_F(Apps, ShowCommonOptionsFirstAndAllWithHelpAll) {
  for (const std::string& command : kCommands) {
    const std::string help = succeed({command, "--help"}), all = succeed({command, "--help-all"});
    EXPECT_LE(std::count(help.begin(), help.end(), '\n'), 30) << help;
    EXPECT_GT(all.size(), help.size()) << all;
    EXPECT_NE(all.find("Example: gaussmap " + command), std::string::npos) << all;
    for (const std::string& text : {help, all}) {
      std::istringstream lines(text);
      for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
    }
  }
  const auto isShown = [&](const std::string& option, const std::string& how) {
    return succeed({"pcd2map", how}).find("  " + option + " ") != std::string::npos;
  };
  for (const char* const option : {"--resolution", "--budget"}) EXPECT_TRUE(isShown(option, "--help")) << option;
  for (const char* const option : {"--ratio", "--max-memory", "--look-back"}) {
    EXPECT_FALSE(isShown(option, "--help")) << option;
    EXPECT_TRUE(isShown(option, "--help-all")) << option;
  }
  EXPECT_NE(succeed({"--help-all"}).find("--look-back"), std::string::npos);  // of all commands
}

TEST_F(Apps, RefuseCommandsThatAreNone) {
  expectUsageError("no command given", {});
  expectUsageError("'pcd2mapp' is not a command", {"pcd2mapp"});
  expectUsageError("pcd2map, scans, refine", {"pcd2mapp", scene("scans"), "-o", own("x.gmap")});
  expectUsageError("'--bad'", {"--bad"});
}

TEST_F(Apps, RefuseOptionsThatAreNone) {
  expectUsageError("--resolutoin", {"pcd2map", scene("scans"), "-o", own("x.gmap"), "--resolutoin", "1"});
  expectUsageError("--scal", {"export", scene("map.gmap"), own("x.pcd"), "--scal", "1"});
  expectUsageError("--output", {"pcd2map", scene("scans")});
  expectUsageError("scans", {"pcd2map", "-o", own("x.gmap")});
  expectUsageError("gaussmap info --help", {"info"});
  expectUsageError(scene("map.pcd"), {"info", scene("map.gmap"), scene("map.pcd")});
}

TEST_F(Apps, RefuseValuesThatMakeNoSense) {
  const auto expectBadOption = [this](const std::string& name, const std::string& value) {
    expectUsageError(name, {"pcd2map", scene("scans"), "-o", own("x.gmap"), name, value});
  };
  for (const char* const value : {"0", "-1", "nan", "inf", "abc", ""}) expectBadOption("--resolution", value);
  for (const char* const value : {"1", "0", "-3", "2.5", "x"}) expectBadOption("--ratio", value);
  for (const char* const value : {"0", "-1", "99", "1.5", "99999999999"}) expectBadOption("--scales", value);
  for (const char* const value : {"0.5", "0", "-1", "nan", "inf", "x", "3x"}) expectBadOption("--budget", value);
  for (const char* const value : {"-1", "nan", "x"}) expectBadOption("--noise", value);
  for (const char* const value : {"-1", "nan", "x", "1e10"}) expectBadOption("--max-range", value);
  for (const char* const value : {"-1", "x", "1.5", "99999999999999999999"}) expectBadOption("--seed", value);
  for (const char* const value : {"-1", "x", "5000"}) expectBadOption("--threads", value);
  for (const char* const value : {"world", ""}) expectBadOption("--frame", value);
  for (const char* const value : {"0.5", "nan"})
    expectUsageError("--budget", {"refine", scene("map.gmap"), "-o", own("x.gmap"), "--budget", value});
  for (const char* const value : {"-1", "nan", "x"})
    expectUsageError("--noise", {"simulate", "-o", own("x"), "--noise", value});
  expectUsageError("--columns", {"simulate", "-o", own("x"), "--columns", "0"});
  expectUsageError("--sampling", {"hausdorff", scene("map.gmap"), scene("truth.pcd"), "--sampling", "area"});
}

TEST_F(Apps, RefuseScalesThatTheMapDoesNotHave) {
  for (const char* const scale : {"3", "64", "-1", "x"}) {
    expectUsageError("--scale", {"export", scene("map.gmap"), own("x.pcd"), "--scale", scale});
    expectUsageError("--scale", {"hausdorff", scene("map.gmap"), scene("truth.pcd"), "--scale", scale});
  }
}

TEST_F(Apps, KeepExistingOutputsUnlessForced) {
  const std::string map = directory_.write("map.gmap", "mine"), cloud = directory_.write("map.pcd", "mine");
  expectUsageError("--force", {"pcd2map", scene("scans"), "-o", map});
  expectUsageError("--force", {"refine", scene("map.gmap"), "-o", map});
  expectUsageError("--force", {"export", scene("map.gmap"), cloud});
  fs::create_directories(own("sim/scans"));
  directory_.write("sim/scans/scan03.pcd", "mine");
  expectUsageError("scan03.pcd", {"simulate", "-o", own("sim"), "--columns", "10"});
  EXPECT_EQ(contentsOf(map) + contentsOf(cloud) + contentsOf(own("sim/scans/scan03.pcd")), "mineminemine");
  succeed({"pcd2map", scene("scans"), "-o", map, "--force"});
  succeed({"refine", scene("map.gmap"), "-o", map, "--force"});
  succeed({"export", scene("map.gmap"), cloud, "--force"});
  succeed({"simulate", "-o", own("sim"), "--columns", "10", "--force"});
  EXPECT_NO_THROW(load(map));
  EXPECT_NO_THROW(loadPcd(cloud));
}

TEST_F(Apps, NeverWriteOverAnInput) {
  const std::string scan = own("scan"), map = own("map.gmap"), cloud = own("cloud.pcd"), poses = own("poses.gmap");
  fs::copy_file(scene("scans/scan00.pcd"), scan);
  fs::copy_file(scene("map.gmap"), map);
  fs::copy_file(scene("map.pcd"), cloud);
  directory_.write("poses.gmap", "0 0 0 0 0 0 0 1\n");
  fs::copy_file(scan, own("next.gmap.part"));
  fs::create_symlink("scan", own("link"));
  for (const std::string& output : {scan, own("link"), own("./scan")})
    expectUsageError("input", {"pcd2map", scan, "-o", output, "--force"});
  expectUsageError("input", {"pcd2map", scan, "-o", scan});  // and does not recommend --force
  expectUsageError("input", {"pcd2map", own("link"), "-o", scan, "--force"});
  expectUsageError("input", {"pcd2map", scan, "-o", poses, "--poses", poses, "--force"});
  expectUsageError("input", {"pcd2map", own("next.gmap.part"), "-o", own("next.gmap")});
  expectUsageError("input", {"refine", map, "-o", map, "--force"});
  expectUsageError("input", {"refine", cloud, "-o", cloud, "--force"});
  expectUsageError("input", {"export", cloud, cloud, "--force"});
  EXPECT_EQ(contentsOf(scan), contentsOf(scene("scans/scan00.pcd")));
  EXPECT_EQ(contentsOf(map), contentsOf(scene("map.gmap")));
  EXPECT_EQ(contentsOf(cloud), contentsOf(scene("map.pcd")));
}

TEST_F(Apps, RefuseOutputsThatCannotBeBeforeTheyBegin) {
  fs::create_directory(own("folder"));
  for (const std::string& output : {own("folder"), own("folder/"), own("missing/x.gmap"), std::string(), own("x.pcd")})
    expectUsageError(output, {"pcd2map", scene("scans"), "-o", output, "--force"});
  expectUsageError(".pcd", {"export", scene("map.gmap"), own("x.txt")});
  expectUsageError("missing", {"export", scene("map.gmap"), own("missing/x.pcd")});
  expectUsageError("file", {"simulate", "-o", directory_.write("file", "mine")});
}

}  // namespace
}  // namespace gaussmap::test
