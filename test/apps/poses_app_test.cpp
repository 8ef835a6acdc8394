// SPDX-License-Identifier: BSD-3-Clause
// Poses as people have them: times, numbers, conventions. Each mistake is found by the real command.
#include <cmath>
#include <sstream>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"
#include "io/gmap/map_equality.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

/// The five scans of the scene without their VIEWPOINT, and their poses.
class PosesApp : public Apps {
 protected:
  void SetUp() override {
    for (const fs::path& scan : listScans({scene("scans")})) {
      poses_.push_back(PcdReader(scan).header().viewpoint);
      std::string bytes = contentsOf(scan);
      const std::size_t begin = bytes.find("VIEWPOINT "), end = bytes.find('\n', begin);
      bytes.replace(begin, end - begin, "VIEWPOINT 0 0 0 1 0 0 0");
      bare_.push_back(std::move(bytes));
    }
  }

  /// Writes the scans under these names and returns their folder.
  std::string scansNamed(const std::string& folder, const std::vector<std::string>& names) const {
    fs::create_directory(own(folder));
    for (std::size_t i = 0; i < names.size(); ++i) directory_.write(folder + "/" + names[i], bare_[i]);
    return own(folder);
  }
  std::string numbered() const { return scansNamed("numbered", {"0.pcd", "1.pcd", "2.pcd", "3.pcd", "4.pcd"}); }
  std::string timed() const {
    return scansNamed("timed", {"1700000010.25.pcd", "1700000011.25.pcd", "1700000012.25.pcd", "1700000013.25.pcd",
                                "1700000014.25.pcd"});
  }

  static std::string text(const Pose& pose) {
    std::ostringstream line;
    line.precision(17);
    line << pose.translation.transpose() << ' ' << pose.rotation.coeffs().transpose();
    return line.str();
  }
  static std::string matrixText(const Pose& pose) {
    const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
    std::ostringstream line;
    line.precision(17);
    for (int row = 0; row < 3; ++row) line << rotation.row(row) << ' ' << pose.translation(row) << ' ';
    return line.str();
  }
  /// Writes a file of the poses with these keys; the pose i is poses_[first + i].
  std::string file(const std::vector<std::string>& keys, std::size_t first = 0) const {
    std::string lines;
    for (std::size_t i = 0; i < keys.size(); ++i) lines += keys[i] + " " + text(poses_.at(first + i)) + "\n";
    return directory_.write("poses.txt", lines).string();
  }

  std::vector<std::string> build(const std::string& scans, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"pcd2map", scans, "-o", own("map.gmap"), "--budget", "1", "--force"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// Expects the map of the scene, and `word` in the line about the poses.
  void expectRight(const std::string& word, const std::string& scans, const std::vector<std::string>& more) const {
    const Outcome outcome = runApp(build(scans, more));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    if (outcome.code == 0) expectSameMap<3>(load(own("map.gmap")), load(scene("map.gmap")));
  }

  std::vector<Pose> poses_;
  std::vector<std::string> bare_;
};

TEST_F(PosesApp, AreMatchedByTimeAndNotByOrder) {
  std::string dense;
  for (int i = 0; i <= 50; ++i) {  // ten per second; those at .2 are the nearest to the scans
    const std::size_t scan = std::min<std::size_t>(4, static_cast<std::size_t>((i + 3) / 10));
    dense += "17000000" + std::to_string(100 + i) + "00000000 " + text(poses_[scan]) + "\n";
  }
  expectRight("matched by time", timed(), {"--poses", directory_.write("dense.tum", dense)});
  expectRight("matched by time", timed(),
              {"--poses",
               file({"1700000010.2501", "1700000011.2501", "1700000012.2501", "1700000013.2501", "1700000014.2501"})});
}

TEST_F(PosesApp, NameTheScanThatHasNoPoseInTime) {
  const std::string poses = file({"1700000011.25", "1700000012.25", "1700000013.25", "1700000014.25"}, 1);
  directory_.write("poses.txt", contentsOf(poses) + "1700000015.25 " + text(poses_[0]) + "\n");  // five for five
  std::vector<std::string> words = build(timed(), {"--poses", poses});
  expectDataError("1 of 5 scans has no pose: 1700000010.25.pcd (1 s from the nearest pose", words);
  expectDataError("--skip-without-pose", words);
  words.emplace_back("--skip-without-pose");
  const Outcome outcome = runApp(words);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: " + poses + ": 1 of 5 scans has no pose"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.out.find(own("map.gmap") + ": 4 scans"), 0u) << outcome.out;
}

TEST_F(PosesApp, SayThatClocksDiffer) {
  const std::string poses = file({"0.5", "1.5", "2.5", "3.5", "4.5"});
  expectDataError("5 of 5 scans have no pose", build(timed(), {"--poses", poses}));
  const Outcome outcome = runApp(build(timed(), {"--poses", poses, "--skip-without-pose"}));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("the times of the scans are from 1700000010.25 s to 1700000014.25 s, those of the poses "
                             "from 0.5 s to 4.5 s; check that both use the same clock, or use --match-poses order"),
            std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.err.find("--max-time-gap"), std::string::npos) << outcome.err;
  // The same clock, but no pose is near enough.
  const std::string off = file({"1700000010.5", "1700000011.5", "1700000012.5", "1700000013.5", "1700000014.5"});
  expectDataError("; give the pose of each scan, or use --max-time-gap if the nearest poses are right\n",
                  build(timed(), {"--poses", off, "--max-time-gap", "0.1"}));
}

TEST_F(PosesApp, AreMatchedByTheNumberOfTheScan) {
  std::string kitti;
  for (const Pose& pose : poses_) kitti += matrixText(pose) + "\n";
  kitti += "1 0 0 9 0 1 0 9 0 0 1 9\n";  // more lines than scans
  const std::string path = directory_.write("kitti.txt", kitti);
  const Json said = Json::parse(succeed({"scans", numbered(), "--poses", path, "--json"}));
  EXPECT_NE(said["poses"].get<std::string>().find("number 0 is the first pose"), std::string::npos) << said;
  for (std::size_t i = 0; i < poses_.size(); ++i)
    EXPECT_NEAR(said["scans"][i]["translation"][0].get<double>(), poses_[i].translation.x(), 1e-12);
  expectRight("matched by index", numbered(), {"--poses", file({"0", "1", "2", "3", "4"})});
  expectDataError("4.pcd (no index 4)", build(numbered(), {"--poses", file({"5", "0", "1", "2", "3"})}));
  expectRight("matched by order", numbered(),
              {"--poses", file({"11", "12", "13", "14", "15"}), "--match-poses", "order"});
}

TEST_F(PosesApp, RefuseADifferentCountWithoutKeys) {
  expectDataError("4 poses for 5 scans", build(numbered(), {"--poses", file({"0.5", "1.5", "2.5", "3.5"})}));
}

TEST_F(PosesApp, AskForTheUnitOfAngles) {
  std::string lines;
  for (std::size_t i = 0; i < poses_.size(); ++i) lines += std::to_string(i) + ",1,2,3,10,0,0\n";
  const std::string poses = directory_.write("angles.csv", lines);
  expectDataError("--pose-format xyzrpy-deg", build(numbered(), {"--poses", poses}));
  EXPECT_EQ(runApp(build(numbered(), {"--poses", poses, "--pose-format", "xyzrpy-deg"})).code, 0);
}

TEST_F(PosesApp, AreReadWithNamedColumns) {
  std::string lines;
  for (const Pose& pose : poses_) {
    const Pose::Rotation& q = pose.rotation;
    std::ostringstream line;
    line.precision(17);
    line << pose.translation.transpose() << ' ' << q.w() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << " 0\n";
    lines += line.str();
  }
  const std::string poses = directory_.write("w_first.txt", lines);
  expectRight("x y z qw qx qy qz", numbered(), {"--poses", poses, "--pose-format", "x y z qw qx qy qz skip"});
  expectUsageError("--pose-format", build(numbered(), {"--poses", poses, "--pose-format", "tumm"}));
}

TEST_F(PosesApp, TakeAnExtrinsic) {
  const Pose sensor = normalised({{0.5, -0.25, 1.0}, Pose::Rotation(0.8, 0.0, 0.6, 0.0)});
  std::string lines;
  for (const Pose& pose : poses_) lines += text(pose * sensor.inverse()) + "\n";
  const std::string poses = directory_.write("vehicle.txt", lines);
  const auto expectClose = [&](const std::string& extrinsic) {
    const Outcome outcome = runApp({"scans", numbered(), "--poses", poses, "--extrinsic", extrinsic, "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json said = Json::parse(outcome.out);
    for (std::size_t i = 0; i < poses_.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(said["scans"][i]["translation"][axis].get<double>(),
                    poses_[i].translation(static_cast<Eigen::Index>(axis)), 1e-9);
  };
  expectClose(text(sensor));
  expectClose(directory_.write("extrinsic.txt", matrixText(sensor)));
  expectUsageError("--extrinsic", build(numbered(), {"--extrinsic", "1 2 3"}));
  expectDataError("none.txt", build(numbered(), {"--extrinsic", own("none.txt")}));
}

TEST_F(PosesApp, ReadTheCalibrationBesideKittiPoses) {
  const Pose lidar = normalised({{0.0, -0.1, -0.3}, Pose::Rotation(0.5, 0.5, -0.5, 0.5)});  // in the camera
  std::string camera;
  for (const Pose& pose : poses_) camera += matrixText(lidar * (poses_[0].inverse() * pose) * lidar.inverse()) + "\n";
  const std::string poses = directory_.write("camera.txt", camera);
  const auto firstMotion = [&](const std::vector<std::string>& more, const std::string& word) {
    std::vector<std::string> words = {"scans", numbered(), "--poses", poses, "--json", "--no-pose-check"};
    words.insert(words.end(), more.begin(), more.end());
    const Json said = Json::parse(succeed(words));
    EXPECT_NE(said["poses"].get<std::string>().find(word), std::string::npos) << said["poses"];
    const Json& t = said["scans"][1]["translation"];
    return Eigen::Vector3d(t[0], t[1], t[2]);
  };
  const Eigen::Vector3d expected = (poses_[0].inverse() * poses_[1]).translation;
  EXPECT_GT((firstMotion({}, "matched by") - expected).norm(), 0.1);
  directory_.write("calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: " + matrixText(lidar) + "\n");
  EXPECT_LT((firstMotion({}, "calib.txt") - expected).norm(), 1e-9);
  EXPECT_GT((firstMotion({"--extrinsic", "none"}, "matched by") - expected).norm(), 0.1);
  // The file of another kind is left alone.
  EXPECT_EQ(runApp({"scans", numbered(), "--poses", file({"0", "1", "2", "3", "4"})}).out.find("calib.txt"),
            std::string::npos);
}

TEST_F(PosesApp, MayBeTheSameForASensorThatStandsStill) {
  // Three scans of one wall from one place, with different noise.
  std::vector<std::string> words = {"pcd2map", "-o", own("map.gmap")};
  for (int scan = 0; scan < 3; ++scan) {
    std::vector<Vector<3>> points;
    for (int i = 0; i < 2000; ++i)
      points.emplace_back(5.0 + 0.004 * ((i * 7 + scan * 3) % 5), 0.1 * (i % 50) - 2.5, 0.1 * (i / 50) - 2.0);
    writePcd(own("still" + std::to_string(scan) + ".pcd"), points);
    words.push_back(own("still" + std::to_string(scan) + ".pcd"));
  }
  succeed(words);
}

TEST_F(PosesApp, ScansShowsOneTable) {
  const std::string table = succeed({"scans", scene("scans"), "--each"});
  for (const char* const row :
       {"files      5: ", "kind       PCD ", "points     ", "fields     x y z", "times      unknown",
        "poses      VIEWPOINT of each scan", "box        [", "warnings   none", "scan04.pcd"})
    EXPECT_NE(table.find(row), std::string::npos) << row << " in:\n" << table;
  const std::string bare = succeed({"scans", numbered()});
  EXPECT_NE(bare.find("warning    all 5 scans have the same pose"), std::string::npos) << bare;

  const Json said = Json::parse(
      succeed({"scans", timed(), "--poses",
               file({"1700000010.25", "1700000011.25", "1700000012.25", "1700000013.25", "1700000014.25"}), "--json"}));
  EXPECT_EQ(said["scans"].size(), 5u);
  EXPECT_EQ(said["times"][0], 1700000010.25);
  EXPECT_EQ(said["points"]["accepted"], Json::parse(succeed({"pcd2map", scene("scans"), "-o", own("m.gmap"), "--json",
                                                             "--budget", "1"}))["points"]["accepted"]);
  EXPECT_EQ(said["scans"][2]["time"], 1700000012.25);
}

TEST_F(PosesApp, ScansFailsAsBuildingWould) {
  const Outcome outcome = runApp({"scans", numbered(), "--poses", file({"0", "1", "2", "3"})});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.out.find("no pose    " + own("numbered/4.pcd") + ": no index 4"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("4.pcd (no index 4)\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("--skip-without-pose"), std::string::npos) << outcome.err;
  EXPECT_EQ(runApp({"scans", numbered(), "--poses", file({"0", "1", "2", "3"}), "--skip-without-pose"}).code, 0);
  expectDataError("does not exist", {"scans", own("none")});
  expectDataError("; give the pose of each scan\n", {"scans", numbered(), "--poses", file({"7.pcd", "8.pcd"}, 3)});
}

TEST_F(PosesApp, OptionsOfPosesNeedPoses) {
  for (const std::vector<std::string>& option : {std::vector<std::string>{"--interpolate"},
                                                 {"--skip-without-pose"},
                                                 {"--max-time-gap", "1"},
                                                 {"--pose-format", "tum"},
                                                 {"--match-poses", "time"}})
    expectUsageError(option.front(), build(numbered(), option));
}

}  // namespace
}  // namespace gaussmap::test
