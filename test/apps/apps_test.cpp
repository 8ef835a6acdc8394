// SPDX-License-Identifier: BSD-3-Clause
// The program as its users meet it: files, exit codes, and what stands on stdout and stderr.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/run_app.h"
#include "gaussmap/io/map_file.h"
#include "gaussmap/io/map_pcd.h"
#include "gaussmap/io/pcd_reader.h"
#include "gaussmap/io/pcd_writer.h"
#include "gaussmap/io/scan_list.h"
#include "gaussmap/mapping/accumulate_scans.h"
#include "gaussmap/mapping/build.h"
#include "io/map_equality.h"
#include "io/temporary_directory.h"

namespace gaussmap {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::contentsOf;
using test::expectSameMap;
using test::Outcome;
using test::runApp;
using test::TemporaryDirectory;

const std::vector<std::string> kCommands = {"pcd2map", "refine", "info", "export", "hausdorff", "simulate"};

/// Five small scans of the demo scene, made once, and a map of them.
class Apps : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = std::make_unique<TemporaryDirectory>();
    ASSERT_EQ(runApp({"simulate", "-o", scene("").string(), "--rings", "8", "--columns", "60"}).code, 0);
    ASSERT_EQ(runApp({"pcd2map", scene("scans"), "-o", scene("map.gmap"), "--budget", "1"}).code, 0);
    ASSERT_EQ(runApp({"export", scene("map.gmap"), scene("map.pcd")}).code, 0);
  }
  static void TearDownTestSuite() { scene_.reset(); }

  static fs::path scene(const std::string& name) { return scene_->path() / name; }
  std::string own(const std::string& name) const { return (directory_.path() / name).string(); }

  std::vector<std::string> ownFiles() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(directory_.path()))
      names.push_back(fs::relative(entry.path(), directory_.path()).string());
    std::sort(names.begin(), names.end());
    return names;
  }

  /// Succeeds in silence on stderr; returns stdout.
  std::string succeed(const std::vector<std::string>& arguments) {
    const Outcome outcome = runApp(arguments);
    EXPECT_EQ(outcome.code, 0) << testing::PrintToString(arguments) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return outcome.out;
  }

  /// Fails with this code and one line on stderr that holds `word`; prints nothing else and makes no file.
  void expectFailure(int code, const std::string& word, const std::vector<std::string>& arguments) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    const std::vector<std::string> before = ownFiles();
    const Outcome outcome = runApp(arguments);
    EXPECT_EQ(outcome.code, code);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.find("gaussmap: "), 0u) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_LT(outcome.err.size(), 600u) << outcome.err;
    EXPECT_EQ(ownFiles(), before);
  }
  void expectUsageError(const std::string& word, const std::vector<std::string>& arguments) {
    expectFailure(2, word, arguments);
  }
  void expectDataError(const std::string& word, const std::vector<std::string>& arguments) {
    expectFailure(1, word, arguments);
  }
  /// pcd2map of the scene with one more option.
  void expectBadOption(const std::string& name, const std::string& value) {
    expectUsageError(name, {"pcd2map", scene("scans"), "-o", own("x.gmap"), name, value});
  }

  static std::unique_ptr<TemporaryDirectory> scene_;
  TemporaryDirectory directory_;
};
std::unique_ptr<TemporaryDirectory> Apps::scene_;

// ---- the main job ---------------------------------------------------------------------------------------------------

TEST_F(Apps, MakeAMapOfScansAndSayHowGoodItIs) {
  const std::vector<fs::path> scans = listScans({scene("scans")});
  ASSERT_EQ(scans.size(), 5u);
  std::vector<ScanSource> sources;
  for (const fs::path& scan : scans) sources.push_back({scan, normalised(PcdReader(scan).header().viewpoint)});
  const AccumulatedScans truth = accumulateScans(sources, {});

  const Json made = Json::parse(succeed({"pcd2map", scene("scans"), "-o", own("a.gmap"), "--budget", "3", "--json"}));
  EXPECT_EQ(made["scans"], 5);
  EXPECT_EQ(made["points"]["read"], truth.counts.read);
  EXPECT_EQ(made["points"]["accepted"], truth.counts.accepted);
  EXPECT_EQ(made["bytes"], fs::file_size(own("a.gmap")));

  const Json info = Json::parse(succeed({"info", own("a.gmap"), "--json"}));
  EXPECT_EQ(info["resolution"], 0.1);
  EXPECT_EQ(info["ratio"], 10);
  EXPECT_EQ(info["finest"], "moments");
  EXPECT_EQ(info["bytes"], fs::file_size(own("a.gmap")));
  ASSERT_EQ(info["scales"].size(), 3u);
  for (std::size_t s = 0; s < 3; ++s) {
    EXPECT_EQ(info["scales"][s]["weight"], truth.counts.accepted);
    EXPECT_GT(info["scales"][s]["bytes"], 0);
  }
  EXPECT_EQ(info["scales"][0]["cells"], truth.moments.size());
  EXPECT_EQ(info["scales"][1]["gaussians"], 3 * info["scales"][1]["cells"].get<int>());
  EXPECT_EQ(info["metadata"]["history"][0]["command"], "pcd2map");
  EXPECT_EQ(info["metadata"]["history"][0]["points"]["accepted"], truth.counts.accepted);
  EXPECT_LT(info["extent"]["low"][0], info["extent"]["high"][0]);

  succeed({"refine", own("a.gmap"), "-o", own("b.gmap"), "--budget", "2"});
  const Json refined = Json::parse(succeed({"info", own("b.gmap"), "--json"}));
  EXPECT_EQ(refined["scales"][1]["gaussians"], 2 * info["scales"][1]["cells"].get<int>());
  EXPECT_EQ(refined["metadata"]["history"].size(), 2u);
  EXPECT_EQ(refined["metadata"]["history"][1]["budget"], 2.0);

  EXPECT_NE(succeed({"export", own("b.gmap"), own("b.pcd"), "--scale", "1"}).find(own("b.pcd")), std::string::npos);
  EXPECT_EQ(PcdReader(own("b.pcd")).size(), refined["scales"][1]["gaussians"]);

  const Json distances = Json::parse(
      succeed({"hausdorff", own("a.gmap"), scene("truth.pcd"), "--frame", "map", "--samples", "5000", "--json"}));
  ASSERT_EQ(distances["scales"].size(), 3u);
  EXPECT_EQ(distances["scales"][0]["all"]["backward"]["count"], truth.counts.read);
  EXPECT_LT(distances["scales"][0]["all"]["hausdorff"], 0.2);  // sensor noise of 1 cm, cells of 10 cm
  EXPECT_GT(distances["scales"][0]["all"]["hausdorff"], 0.001);
  EXPECT_LT(distances["scales"][0]["all"]["forward"]["mean"], distances["scales"][2]["all"]["forward"]["mean"]);
}

TEST_F(Apps, RefineAMapAsPcd2mapWouldHave) {
  succeed({"pcd2map", scene("scans"), "-o", own("three.gmap"), "--budget", "3", "--seed", "5"});
  succeed({"refine", scene("map.gmap"), "-o", own("refined.gmap"), "--budget", "3", "--seed", "5"});
  expectSameMap<3>(loadMap<3>(own("refined.gmap")), loadMap<3>(own("three.gmap")));
  succeed({"refine", own("three.gmap"), "-o", own("one.gmap"), "--budget", "1"});
  expectSameMap<3>(loadMap<3>(own("one.gmap")), loadMap<3>(scene("map.gmap")));
}

TEST_F(Apps, GiveTheSameFileForAnyNumberOfThreads) {
  std::vector<std::string> files, prints;
  for (const std::string threads : {"1", "2", "0", "7"}) {
    const std::string map = own("map" + threads), fine = own("fine" + threads);
    succeed({"pcd2map", scene("scans"), "-o", map, "--budget", "2", "--threads", threads});
    succeed({"refine", map, "-o", fine, "--budget", "3", "--threads", threads});
    files.push_back(contentsOf(map) + contentsOf(fine));
    prints.push_back(succeed({"hausdorff", scene("map.gmap"), scene("truth.pcd"), "--frame", "map", "--samples", "3000",
                              "--threads", threads}));
  }
  for (std::size_t i = 1; i < files.size(); ++i) {
    EXPECT_TRUE(files[i] == files[0]);
    EXPECT_EQ(prints[i], prints[0]);
  }
}

TEST_F(Apps, TakeExportedMapsAsMaps) {
  const Json of_map = Json::parse(succeed({"info", scene("map.gmap"), "--json"}));
  const Json of_pcd = Json::parse(succeed({"info", scene("map.pcd"), "--json"}));
  EXPECT_EQ(of_pcd["finest"], "gaussians");
  EXPECT_EQ(of_pcd["resolution"], 0.1);
  for (std::size_t s = 0; s < 3; ++s)
    for (const char* const name : {"cells", "gaussians", "weight", "cell_side"})
      EXPECT_EQ(of_pcd["scales"][s][name], of_map["scales"][s][name]);
  succeed({"refine", scene("map.pcd"), "-o", own("refined.gmap"), "--budget", "2"});
  succeed({"export", own("refined.gmap"), own("again.pcd")});
  succeed({"hausdorff", own("again.pcd"), scene("truth.pcd"), "--frame", "map", "--samples", "1000", "--scale", "0"});
}

TEST_F(Apps, CompareCloudsWithClouds) {
  const Json same = Json::parse(succeed({"hausdorff", scene("scans"), scene("scans"), "--json"}));
  EXPECT_EQ(same["all"]["hausdorff"], 0.0);
}

TEST_F(Apps, PrintTheSameNumbersForPeople) {
  const std::string text = succeed({"info", scene("map.gmap")});
  const Json info = Json::parse(succeed({"info", scene("map.gmap"), "--json"}));
  for (std::size_t s = 0; s < 3; ++s)
    EXPECT_NE(text.find(" " + std::to_string(info["scales"][s]["cells"].get<int>()) + " "), std::string::npos) << text;
  EXPECT_NE(text.find("pcd2map"), std::string::npos);
  EXPECT_EQ(text.find('{'), std::string::npos) << text;
}

TEST_F(Apps, TakePosesFromAFile) {
  std::string poses;
  std::vector<std::string> bare;
  for (const fs::path& scan : listScans({scene("scans")})) {
    const PcdReader reader(scan);
    const Pose& pose = reader.header().viewpoint;
    std::vector<Vector<3>> points;
    PointBlock<3> block;
    for (std::size_t first = 0; reader.read(first, block), block.size > 0; first += block.size)
      for (std::size_t i = 0; i < block.size; ++i)
        points.emplace_back(block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i]);
    bare.push_back(own(scan.filename()));
    writePcd(bare.back(), points);  // no VIEWPOINT
    std::ostringstream line;
    line.precision(17);
    line << bare.size() << ' ' << pose.translation.transpose() << ' ' << pose.rotation.coeffs().transpose() << '\n';
    poses += line.str();
  }
  const std::string pose_file = directory_.write("poses.txt", poses);
  std::vector<std::string> arguments = {"pcd2map", "-o", own("map.gmap"), "--budget", "1", "--poses", pose_file};
  arguments.insert(arguments.end(), bare.begin(), bare.end());
  succeed(arguments);
  expectSameMap<3>(loadMap<3>(own("map.gmap")), loadMap<3>(scene("map.gmap")));

  // Without the poses: a map, but not without a word.
  arguments = {"pcd2map", "-o", own("wrong.gmap")};
  arguments.insert(arguments.end(), bare.begin(), bare.end());
  const Outcome outcome = runApp(arguments);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err.find("gaussmap: warning: all 5 scans have the same pose"), 0u) << outcome.err;
  EXPECT_NE(outcome.err.find("--poses"), std::string::npos) << outcome.err;
  arguments.insert(arguments.end(), {"--frame", "map", "--force"});
  succeed(arguments);  // said to be so: no warning
}

TEST_F(Apps, LeaveOutFarPointsAndSaySo) {
  const std::string path = own("scan.pcd");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  writePcd(path, {{1, 1, 1}, {2, 2, 2}, {30, 0, 0}, {0, 0, 0}, {nan, 0, 0}});
  const std::string text = succeed({"pcd2map", path, "-o", own("map.gmap"), "--max-range", "10"});
  EXPECT_NE(text.find("1 scan, 2 points (left out: 1 not finite, 1 at range 0, 1 too far)"), std::string::npos) << text;
  EXPECT_EQ(loadMap<3>(own("map.gmap")).weight(2), 2.0);
}

TEST_F(Apps, WarnOfScansGivenTwice) {
  const Outcome outcome =
      runApp({"pcd2map", scene("scans"), scene("scans/../scans/scan01.pcd"), "-o", own("map.gmap")});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err.find("gaussmap: warning: " + scene("scans/../scans/scan01.pcd").string() +
                             " is given more than once"),
            0u)
      << outcome.err;
}

TEST_F(Apps, SimulateTheSameScansForTheSameSeed) {
  succeed({"simulate", "-o", own("a"), "--rings", "4", "--columns", "20"});
  succeed({"simulate", "-o", own("b"), "--rings", "4", "--columns", "20"});
  succeed({"simulate", "-o", own("c"), "--rings", "4", "--columns", "20", "--seed", "2"});
  for (const std::string name : {"/scans/scan00.pcd", "/scans/scan04.pcd"}) {
    EXPECT_EQ(contentsOf(own("a" + name)), contentsOf(own("b" + name)));
    EXPECT_NE(contentsOf(own("a" + name)), contentsOf(own("c" + name)));
  }
  EXPECT_EQ(contentsOf(own("a/truth.pcd")), contentsOf(own("b/truth.pcd")));
}

TEST_F(Apps, PrintJsonWhateverTheNameOfAFile) {  // JSON must be UTF-8, file names need not
  const std::string odd =
      own("gr\xfc\xdf"
          "e.gmap");
  fs::copy_file(scene("map.gmap"), odd);
  EXPECT_TRUE(Json::parse(succeed({"info", odd, "--json"})).contains("map"));
}

TEST_F(Apps, PrintMetadataThatAreCalledLikeTheirOwn) {
  saveMap<3>(loadMap<3>(scene("map.gmap")), own("map.gmap"),
             {{"scales", "mine"}, {"history", "nonsense"}, {"n", "[1]"}});
  const Json info = Json::parse(succeed({"info", own("map.gmap"), "--json"}));
  EXPECT_EQ(info["scales"].size(), 3u);
  EXPECT_EQ(info["metadata"]["scales"], "mine");
  EXPECT_EQ(info["metadata"]["n"][0], 1);
  succeed({"info", own("map.gmap")});
  succeed({"refine", own("map.gmap"), "-o", own("new.gmap")});
  EXPECT_EQ(loadMetadata(own("new.gmap")).at("scales"), "mine");
}

// ---- help -----------------------------------------------------------------------------------------------------------

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

// ---- wrong usage: 2 -------------------------------------------------------------------------------------------------

TEST_F(Apps, RefuseCommandsThatAreNone) {
  expectUsageError("no command given", {});
  expectUsageError("'pcd2mapp' is no command", {"pcd2mapp"});
  expectUsageError("pcd2map, refine", {"pcd2mapp", scene("scans"), "-o", own("x.gmap")});
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
  EXPECT_NO_THROW(loadMap<3>(map));
  EXPECT_NO_THROW(loadMapPcd(cloud));
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

// ---- bad data: 1 ----------------------------------------------------------------------------------------------------

TEST_F(Apps, NameTheInputThatIsMissing) {
  expectDataError(own("no.pcd") + ": ", {"pcd2map", own("no.pcd"), "-o", own("x.gmap")});
  expectDataError(own("no.pcd") + ": ", {"pcd2map", scene("scans"), own("no.pcd"), "-o", own("x.gmap")});
  expectDataError(own("no.gmap") + ": ", {"info", own("no.gmap")});
  expectDataError(own("no.gmap") + ": ", {"refine", own("no.gmap"), "-o", own("x.gmap")});
  expectDataError(own("no.gmap") + ": ", {"export", own("no.gmap"), own("x.pcd")});
  expectDataError(own("no.gmap") + ": ", {"hausdorff", own("no.gmap"), scene("truth.pcd")});
  expectDataError(own("no.pcd") + ": ", {"hausdorff", scene("map.gmap"), own("no.pcd")});
  expectDataError(own("no.txt") + ": ", {"pcd2map", scene("scans"), "-o", own("x.gmap"), "--poses", own("no.txt")});
}

TEST_F(Apps, NameTheDirectoryThatIsEmpty) {
  fs::create_directory(own("empty"));
  expectDataError(own("empty") + ": ", {"pcd2map", own("empty"), "-o", own("x.gmap")});
  expectDataError(own("empty") + ": ", {"info", own("empty")});
}

TEST_F(Apps, NameTheScanThatIsDamaged) {
  fs::copy(scene("scans"), own("scans"));
  const std::string bytes = contentsOf(own("scans/scan02.pcd"));
  for (const std::string& damaged : {bytes.substr(0, bytes.size() / 2), std::string(), std::string("hello\n")}) {
    directory_.write("scans/scan02.pcd", damaged);
    expectDataError(own("scans/scan02.pcd") + ": ", {"pcd2map", own("scans"), "-o", own("x.gmap")});
  }
  directory_.write(
      "scans/scan02.pcd",
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n"
      "1 2 three\n");
  expectDataError(own("scans/scan02.pcd") + ": line 10", {"pcd2map", own("scans"), "-o", own("x.gmap")});
  directory_.write(
      "scans/scan02.pcd",
      "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n"
      "1 2 1e12\n");
  expectDataError(own("scans/scan02.pcd") + ": ", {"pcd2map", own("scans"), "-o", own("x.gmap")});
  directory_.write(
      "scans/scan02.pcd",
      "VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 0 0 0 0\n"
      "POINTS 1\nDATA ascii\n1 2 3\n");
  expectDataError(own("scans/scan02.pcd") + ": ", {"pcd2map", own("scans"), "-o", own("x.gmap")});
}

TEST_F(Apps, NameTheMapThatIsDamaged) {
  std::string bytes = contentsOf(scene("map.gmap"));
  for (std::size_t i = bytes.size() / 3; i < bytes.size(); i += 64) bytes[i] = static_cast<char>(~bytes[i]);
  const std::string cloud_bytes = contentsOf(scene("map.pcd"));
  for (const std::string& map :
       {directory_.write("flipped.gmap", bytes).string(), directory_.write("cut.gmap", bytes.substr(0, 5000)).string(),
        directory_.write("empty.gmap", "").string(), directory_.write("text.gmap", "hello").string(),
        directory_.write("cut.pcd", cloud_bytes.substr(0, cloud_bytes.size() - 9)).string(),
        scene("truth.pcd").string()}) {
    expectDataError(map + ": ", {"info", map});
    expectDataError(map + ": ", {"refine", map, "-o", own("x.gmap")});
    expectDataError(map + ": ", {"export", map, own("x.pcd")});
  }
  expectDataError(own("flipped.gmap") + ": ", {"hausdorff", own("flipped.gmap"), scene("truth.pcd")});
  saveMap<2>(build<2>({{1.0, 2.0}}, {}), own("plane.gmap"));
  expectDataError(own("plane.gmap") + ": ", {"info", own("plane.gmap")});
}

TEST_F(Apps, TakeNoMapForAScan) {
  expectDataError("Gaussians of a map", {"pcd2map", scene("map.pcd"), "-o", own("x.gmap")});
  expectDataError(scene("map.gmap").string() + ": ", {"pcd2map", scene("map.gmap"), "-o", own("x.gmap")});
}

TEST_F(Apps, NameThePoseFileThatDoesNotFit) {
  for (const char* const poses : {"0 0 0 0 0 0 0 1\n", "", "1 2 3\n", "hello\n"}) {
    directory_.write("poses.txt", poses);
    expectDataError(own("poses.txt") + ": ",
                    {"pcd2map", scene("scans"), "-o", own("x.gmap"), "--poses", own("poses.txt")});
  }
}

TEST_F(Apps, NameTheScanWithoutAUsablePoint) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  writePcd(own("nan.pcd"), {{nan, 1, 2}, {0, nan, 0}});
  writePcd(own("none.pcd"), std::vector<Vector<3>>{});
  for (const char* const name : {"nan.pcd", "none.pcd"}) {
    expectDataError(own(name) + ": ", {"pcd2map", own(name), "-o", own("x.gmap")});
    expectDataError(own(name) + ": ", {"hausdorff", scene("map.gmap"), own(name)});
    expectDataError(own(name) + ": ", {"hausdorff", own(name), scene("truth.pcd")});
  }
  fs::copy_file(own("nan.pcd"), own("again.pcd"));
  expectDataError(own("nan.pcd") + " and 1 more: ", {"pcd2map", own("nan.pcd"), own("again.pcd"), "-o", own("x.gmap")});
}

TEST_F(Apps, SayThatTheirOutputGoesNowhere) {
  const Outcome outcome = runApp({"info", scene("map.gmap")}, "/dev/full");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("standard output"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace gaussmap
