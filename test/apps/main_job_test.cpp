// SPDX-License-Identifier: BSD-3-Clause
// Scans -> map -> refined map -> distances.
#include <limits>
#include <sstream>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

TEST_F(Apps, MakeAMapOfScansAndSayHowGoodItIs) {
  const std::vector<fs::path> scans = listScans({scene("scans")});
  ASSERT_EQ(scans.size(), 5u);
  std::vector<FileScan> sources;
  for (const fs::path& scan : scans) sources.push_back({scan, normalised(PcdReader(scan).header().viewpoint)});
  const AccumulatedScans truth = accumulateScans(FileScans(sources), {});

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
  expectSameMap<3>(load(own("refined.gmap")), load(own("three.gmap")));
  succeed({"refine", own("three.gmap"), "-o", own("one.gmap"), "--budget", "1"});
  expectSameMap<3>(load(own("one.gmap")), load(scene("map.gmap")));
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
    line << bare.size() << ".5 " << pose.translation.transpose() << ' ' << pose.rotation.coeffs().transpose() << '\n';
    poses += line.str();
  }
  const std::string pose_file = directory_.write("poses.txt", poses);
  std::vector<std::string> arguments = {"pcd2map", "-o", own("map.gmap"), "--budget", "1", "--poses", pose_file};
  arguments.insert(arguments.end(), bare.begin(), bare.end());
  EXPECT_EQ(runApp(arguments).err,
            "gaussmap: note: " + pose_file + ": TUM (time x y z qx qy qz qw), 5 poses for 5 scans, matched by order\n");
  expectSameMap<3>(load(own("map.gmap")), load(scene("map.gmap")));

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
  EXPECT_EQ(load(own("map.gmap")).weight(2), 2.0);
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

TEST_F(Apps, PrintJsonWhateverTheNameOfAFile) {  // JSON must be UTF-8, file names need not
  const std::string odd =
      own("gr\xfc\xdf"
          "e.gmap");
  fs::copy_file(scene("map.gmap"), odd);
  EXPECT_TRUE(Json::parse(succeed({"info", odd, "--json"})).contains("map"));
}

TEST_F(Apps, PrintMetadataThatAreCalledLikeTheirOwn) {
  save(own("map.gmap"), load(scene("map.gmap")), {{"scales", "mine"}, {"history", "nonsense"}, {"n", "[1]"}});
  const Json info = Json::parse(succeed({"info", own("map.gmap"), "--json"}));
  EXPECT_EQ(info["scales"].size(), 3u);
  EXPECT_EQ(info["metadata"]["scales"], "mine");
  EXPECT_EQ(info["metadata"]["n"][0], 1);
  succeed({"info", own("map.gmap")});
  succeed({"refine", own("map.gmap"), "-o", own("new.gmap")});
  EXPECT_EQ(loadMetadata(own("new.gmap")).at("scales"), "mine");
}

}  // namespace
}  // namespace gaussmap::test
