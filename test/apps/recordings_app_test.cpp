// SPDX-License-Identifier: BSD-3-Clause
// Recordings as robots have them. Each must end in the map of the exact poses, or in one line that names the option to
// give. The recordings and the truth are written by test/data/formats/robots/make.py, with independent writers.
#include <cmath>
#include <fstream>
#include <sstream>

#include "apps/app_fixture.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/scans/pose_file.h"

namespace gaussmap::test {
namespace {

using Words = std::vector<std::string>;

std::string robot(const std::string& name) {
  return std::string(GAUSSMAP_TEST_DATA) + "/formats/robots/" + name;
}

/// The scans that a recording has, as PCD files without poses, and a file of their poses.
struct Truth {
  std::string scans, poses;
};

const Truth kInMap = {"lidar", "lidar"}, kInOdom = {"lidar", "lidar_in_odom"}, kRear = {"rear", "rear"},
            kDepth = {"depth", "depth"}, kLaser = {"laser", "laser_in_odom"},
            kFromFirst = {"lidar", "lidar_from_first"};

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::string> scansOf(const Truth& truth) {
  std::vector<std::string> scans;
  for (const auto& entry : std::filesystem::directory_iterator(robot("truth/" + truth.scans)))
    scans.push_back(entry.path().string());
  std::sort(scans.begin(), scans.end());
  return scans;
}

/// Returns success, or what differs by more than rounding.
testing::AssertionResult sameButForRounding(const GaussianMap<3>& a, const GaussianMap<3>& b) {
  for (int s = 0; s < a.scales(); ++s) {
    const MapScale<3>&x = a.scale(s), &y = b.scale(s);
    if (x.keys != y.keys) return testing::AssertionFailure() << "cells of scale " << s;
    if (x.gaussians.size() != y.gaussians.size()) return testing::AssertionFailure() << "Gaussians of scale " << s;
    for (std::size_t i = 0; i < x.gaussians.size(); ++i)
      if ((x.gaussians[i].mean - y.gaussians[i].mean).norm() > 1e-4 || x.gaussians[i].weight != y.gaussians[i].weight)
        return testing::AssertionFailure() << "Gaussian " << i << " of scale " << s;
  }
  return testing::AssertionSuccess();
}

class RecordingsApp : public AppTest {
 protected:
  Words build(const Words& inputs, const std::string& map = "map.gmap") const {
    return joined({"pcd2map", "-o", own(map), "--force", "--resolution", "0.2", "--budget", "1"}, inputs);
  }

  /// Builds the map of the first scans from the exact poses; all scans if `count` is 0.
  void buildTruth(const Truth& truth, const Words& mode = {}, std::size_t first = 0, std::size_t count = 0) const {
    const std::vector<std::string> all = scansOf(truth);
    const std::size_t last = count == 0 ? all.size() : first + count;
    const Words scans(all.begin() + std::ptrdiff_t(first), all.begin() + std::ptrdiff_t(last));
    const Words poses = {"--poses", robot("truth/" + truth.poses + ".tum"), "--no-pose-check"};
    succeed(joined(joined(build(scans, "truth.gmap"), poses), mode));
  }
  testing::AssertionResult isTruth() const {
    return sameButForRounding(load(own("map.gmap")), load(own("truth.gmap")));
  }

  /// Expects the map of the exact poses. `mode` are options for both maps. Returns stderr.
  std::string expectRight(const Truth& truth, const std::string& recording, const Words& options = {},
                          const Words& mode = {}) const {
    const Words words = joined(joined(build({robot(recording)}), options), mode);
    SCOPED_TRACE(testing::PrintToString(words));
    buildTruth(truth, mode);
    const Outcome outcome = runApp(words);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (outcome.code == 0) {
      EXPECT_TRUE(isTruth()) << outcome.err;
    }
    return outcome.err;
  }
  void expectRightWithAndWithoutOnline(const Truth& truth, const std::string& recording,
                                       const Words& options = {}) const {
    expectRight(truth, recording, options);
    expectRight(truth, recording, options, {"--online"});
  }
  /// Expects that a map is refused in one line with this text.
  void expectAdvice(const std::string& text, const Words& inputs) const { expectDataError(text, build(inputs)); }

  static std::string extrinsic() { return robot("truth/lidar_on_robot.txt"); }
};

// ---- No option is needed ----

TEST_F(RecordingsApp, TakePosesFromTf) {
  expectRightWithAndWithoutOnline(kInMap, "tf.mcap");
  expectRight(kInOdom, "tf.mcap", {"--fixed-frame", "odom"});
  expectRight(kInMap, "slashes.bag");  // ROS 1, frames with a slash in front
}

TEST_F(RecordingsApp, TakePosesFromOdometryAndWhereTheSensorIsFromTf) {
  expectRightWithAndWithoutOnline(kInOdom, "odometry.mcap");
}

TEST_F(RecordingsApp, ApplyTheOpticalFrameOfADepthCamera) {
  expectRightWithAndWithoutOnline(kDepth, "depth.mcap");
}

TEST_F(RecordingsApp, InterpolateBetweenTransforms) {
  expectRight(kInMap, "delayed_tf.mcap");  // recorded up to half a second late
  expectRight(kInOdom, "slow_tf.mcap");
}

TEST_F(RecordingsApp, OfTwoPartsAreOneIfTheirFolderIsGiven) {
  expectRight(kInMap, "split");   // MCAP; only the first part has tf_static
  expectRight(kInMap, "packed");  // sqlite3, compressed
}

TEST_F(RecordingsApp, WithoutTimesInTheHeadersUseThoseOfRecordingAndSaySo) {
  const std::string err = expectRight(kInMap, "zero_times.mcap");
  EXPECT_NE(err.find("5 scans have no time in the header"), std::string::npos) << err;
}

TEST_F(RecordingsApp, OfPointsInTheMapFrameNeedNoPoses) {
  const std::string err = expectRight(kFromFirst, "fast_lio.mcap");
  EXPECT_NE(err.find("positions of the sensor are unknown"), std::string::npos) << err;
}

TEST_F(RecordingsApp, OfAPlanarLaserGiveAMap) {
  expectRightWithAndWithoutOnline(kLaser, "laser.mcap");
}

// ---- One line names the option, and the option works ----

TEST_F(RecordingsApp, OfSeveralSensorsNeedATopic) {
  expectAdvice("--topic", {robot("two_lidars.mcap")});
  expectRightWithAndWithoutOnline(kInMap, "two_lidars.mcap", {"--topic", "/velodyne_points"});
  expectRight(kRear, "two_lidars.mcap", {"--topic", "rear/points"});
  expectDataError("--topic", {"clean", robot("two_lidars.mcap"), "-o", own("clean")});
  expectAdvice("/rear/points", {robot("two_lidars.mcap"), "--topic", "/other"});
}

TEST_F(RecordingsApp, OfASlamProgramNeedTheNameOfItsTopic) {
  expectAdvice("--poses /slam/pose", {robot("slam_pose.mcap")});
  expectRight(kInMap, "slam_pose.mcap", {"--poses", "/slam/pose", "--pose-frame", "base_link"});
}

TEST_F(RecordingsApp, WithoutPosesNeedAFile) {
  expectAdvice("--poses FILE", {robot("no_poses.mcap")});
  expectRightWithAndWithoutOnline(kInMap, "no_poses.mcap", {"--poses", robot("truth/lidar.tum")});
  expectRight(kInMap, "no_poses.mcap", {"--poses", robot("truth/robot.tum"), "--extrinsic", extrinsic()});
}

TEST_F(RecordingsApp, OfOdometryOnlyNeedAnExtrinsic) {
  const Outcome outcome = runApp(build({robot("odometry_only.mcap")}));
  EXPECT_NE(outcome.err.find("--extrinsic"), std::string::npos) << outcome.err;
  expectRight(kInOdom, "odometry_only.mcap", {"--extrinsic", extrinsic()});
}

TEST_F(RecordingsApp, WhoseTransformsBeginLateLeaveOutTheFirstScans) {
  expectAdvice("--skip-without-pose", {robot("late_tf.mcap")});
  buildTruth(kInMap, {}, 2, 3);
  const Outcome outcome = runApp(build({robot("late_tf.mcap"), "--skip-without-pose"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("2 of 5 scans have no pose"), std::string::npos) << outcome.err;
  EXPECT_TRUE(isTruth());
}

TEST_F(RecordingsApp, ThatWereNotFinishedKeepTheirFirstScans) {
  expectAdvice("--skip-without-pose", {robot("unfinished.mcap")});  // the last scan comes after the last transform
  buildTruth(kInMap, {}, 0, 3);
  const Outcome outcome = runApp(build({robot("unfinished.mcap"), "--skip-without-pose"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("was not finished"), std::string::npos) << outcome.err;
  EXPECT_TRUE(isTruth());
}

TEST_F(RecordingsApp, OfTwoClocksNeedTheTimesOfRecording) {
  expectAdvice("--log-times", {robot("boot_clock.mcap")});
  expectRight(kInMap, "boot_clock.mcap", {"--log-times"});
}

TEST_F(RecordingsApp, WhoseSimulatedTimeStartsAgainAreNotMixed) {
  // The same times come twice, at different places.
  expectAdvice("--log-times", {robot("clock_reset.mcap")});
  // Clouds and transforms are not recorded after equal delays, so the poses are a little off.
  const auto boxOf = [](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"scans", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return Json::parse(succeed(words))["box"];
  };
  const Json box = boxOf({robot("clock_reset.mcap"), "--log-times"}), truth = boxOf({robot("tf.mcap")});
  for (const char* const corner : {"low", "high"})
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(box[corner][axis].get<double>(), truth[corner][axis].get<double>(), 0.1) << corner << axis;
}

TEST_F(RecordingsApp, WhoseTransformsLackTheLidarNeedAnExtrinsic) {
  expectAdvice("--pose-frame", {robot("without_lidar_frame.mcap")});
  expectRight(kInMap, "without_lidar_frame.mcap",
              {"--poses", "tf", "--pose-frame", "base_link", "--extrinsic", extrinsic()});
}

TEST_F(RecordingsApp, OfPointsInTheMapFrameTakeThePositionsOfTheSensorFromATopic) {
  expectAdvice("--poses", {robot("fast_lio.mcap"), "--online"});
  expectRight(kFromFirst, "fast_lio.mcap", {"--poses", "/Odometry", "--frame", "map"}, {"--online"});
}

TEST_F(RecordingsApp, MountTheSensorOnTheRobotWhosePosesAreInAFile) {
  expectRight(kInMap, "tf.mcap", {"--poses", robot("truth/robot.tum"), "--pose-frame", "base_link"});
  expectAdvice("tf has no such frame", {robot("tf.mcap"), "--poses", robot("truth/robot.tum"), "--pose-frame", "x"});
}

TEST_F(RecordingsApp, WarnIfOptionsAndFramesContradictEachOther) {
  const Outcome moving = runApp(build({robot("tf.mcap"), "--frame", "map"}));
  EXPECT_NE(moving.err.find("which moves, but --frame map"), std::string::npos) << moving.err;
  const Outcome unused = runApp(build({robot("fast_lio.mcap"), "--poses", "/Odometry"}));
  EXPECT_NE(unused.err.find("so the poses are not used"), std::string::npos) << unused.err;
  expectUsageError("a topic begins with a slash: --poses /odom", build({robot("odometry.mcap"), "--poses", "odom"}));
  expectAdvice("this is the frame of the scans, which moves", {robot("tf.mcap"), "--fixed-frame", "velodyne"});
}

TEST_F(RecordingsApp, InDifferentFramesAreNotMixed) {
  expectAdvice("--fixed-frame", {robot("tf.mcap"), robot("laser.mcap")});
  const Outcome outcome = runApp(build({robot("tf.mcap"), robot("laser.mcap"), "--fixed-frame", "odom"}));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("the map is wrong if they are different runs"), std::string::npos) << outcome.err;
}

TEST_F(RecordingsApp, PreferTheMapFrameOfARobotWithANamespace) {
  expectRight(kInMap, "namespace.mcap");
  expectRight(kInMap, "namespace.mcap", {"--poses", "tf"});
  expectRight(kInOdom, "namespace.mcap", {"--poses", "/robot1/odom"});
}

TEST_F(RecordingsApp, AreInterpolatedWithAnyTimeGap) {
  expectRight(kInOdom, "slow_tf.mcap", {"--max-time-gap", "0.3"});
  expectRight(kInMap, "tf.mcap", {"--max-time-gap", "2"});
}

TEST_F(RecordingsApp, RefuseNamesThatTheyDoNotHave) {
  expectAdvice("/scan", {robot("laser.mcap"), "--topic", "/lidar"});
  expectAdvice("/odom", {robot("odometry.mcap"), "--poses", "/other"});
  expectAdvice("other", {robot("tf.mcap"), "--fixed-frame", "other"});
  expectAdvice("other", {robot("odometry.mcap"), "--fixed-frame", "other"});
  expectAdvice("other", {robot("tf.mcap"), "--pose-frame", "other"});
  expectAdvice("other", {robot("odometry.mcap"), "--pose-frame", "other"});
}

// ---- The other commands ----

TEST_F(RecordingsApp, AreListedWithTheirTopics) {
  const Json said = Json::parse(succeed({"scans", robot("tf.mcap"), "--json"}));
  EXPECT_EQ(said["scans"].size(), 5u);
  EXPECT_EQ(said["poses"], "tf: velodyne in map");
  std::vector<std::string> topics;
  for (const Json& topic : said["recordings"][0]["topics"])
    topics.push_back(topic["topic"].get<std::string>() + " " + topic["messages"].dump() + " " +
                     topic["frame"].get<std::string>());
  EXPECT_EQ(topics, (Words{"/tf_static 1 base_link", "/tf 23 odom", "/velodyne_points 5 velodyne"}));
  // The topics are shown even if pcd2map would stop.
  const Outcome outcome = runApp({"scans", robot("two_lidars.mcap")});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.out.find("velodyne_rear"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("--topic"), std::string::npos) << outcome.err;
}

TEST_F(RecordingsApp, AreRegisteredWithoutPoses) {
  succeed(build({robot("tf.mcap")}));
  const Words guess = {"--guess", "2.6", "3.9", "1", "-0.058", "0.069", "0.116", "0.989"};
  succeed(joined({"register", robot("no_poses.mcap"), own("map.gmap"), "--tum", own("found.tum")}, guess));
  const PoseFile found = readPoseFile(own("found.tum")), truth = readPoseFile(robot("truth/lidar.tum"));
  ASSERT_EQ(found.entries.size(), truth.entries.size());
  for (std::size_t i = 0; i < truth.entries.size(); ++i) {
    EXPECT_LT((found.entries[i].pose->translation - truth.entries[i].pose->translation).norm(), 0.01) << i;
    EXPECT_LT(found.entries[i].pose->rotation.angularDistance(truth.entries[i].pose->rotation), 0.01) << i;
    EXPECT_EQ(found.entries[i].time, truth.entries[i].time) << i;
  }
}

TEST_F(RecordingsApp, AreCleaned) {
  succeed({"clean", robot("tf.mcap"), "-o", own("clean")});
  Words cleaned;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(own("clean")))
    if (entry.path().extension() == ".pcd") cleaned.push_back(entry.path().string());
  ASSERT_EQ(cleaned.size(), 5u);
  std::sort(cleaned.begin(), cleaned.end());
  succeed(build(cleaned));
  buildTruth(kInMap);
  EXPECT_TRUE(isTruth());  // nothing moved, and the poses are in the files
}

/// Returns the numbers of a table without its header.
std::vector<double> numbersIn(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::vector<double> numbers;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::stod(cell));
  }
  return numbers;
}

TEST_F(RecordingsApp, OfAPlanarLaserGiveSegments) {
  succeed({"segments", robot("laser.mcap"), "-o", own("segments.csv")});
  succeed(joined({"segments", "-o", own("truth.csv"), "--poses", robot("truth/laser_in_odom.tum")}, scansOf(kLaser)));
  // The last digits of the poses differ, and the fit is random, so single ends of segments can differ.
  const auto lengthIn = [this](const std::string& name) {
    constexpr std::size_t kColumns = 13, kLength = 6;
    const std::vector<double> numbers = numbersIn(own(name));
    EXPECT_EQ(numbers.size() % kColumns, 0u);
    double sum = 0.0;
    for (std::size_t i = kLength; i < numbers.size(); i += kColumns) sum += numbers[i];
    return sum;
  };
  EXPECT_GT(lengthIn("truth.csv"), 15.0);
  EXPECT_NEAR(lengthIn("segments.csv"), lengthIn("truth.csv"), 0.5);
}

}  // namespace
}  // namespace gaussmap::test
