// SPDX-License-Identifier: BSD-3-Clause
// gaussmap register through the real program.
#include <cmath>
#include <fstream>
#include <iterator>

#include "apps/app_fixture.h"
#include "gaussmap/io/scans/pose_file.h"

namespace gaussmap::test {
namespace {

class RegisterApp : public AppTest {
 protected:
  static void SetUpTestSuite() {
    world_ = std::make_unique<TemporaryDirectory>();
    succeed({"simulate", "hall", "-o", world("hall"), "--scans", "20", "--columns", "360"});
    succeed({"pcd2map", world("hall/scans/scan00.pcd"), world("hall/scans/scan01.pcd"), world("hall/scans/scan02.pcd"),
             "-o", world("map.gmap"), "--resolution", "0.2", "--ratio", "3", "--scales", "4"});
    succeed({"pcd2map", world("hall/scans"), "-o", world("whole.gmap"), "--resolution", "0.2", "--ratio", "3",
             "--scales", "4", "--no-curves"});
  }
  static void TearDownTestSuite() { world_.reset(); }
  static std::string world(const std::string& name) { return (world_->path() / name).string(); }
  static std::string scan(int i) { return world("hall/scans/scan0" + std::to_string(i) + ".pcd"); }
  static std::string anyScan(std::size_t i) {
    return world(std::string("hall/scans/scan") + (i < 10 ? "0" : "") + std::to_string(i) + ".pcd");
  }
  static Pose truth(std::size_t i) { return readPoseFile(world("hall/trajectory.tum")).entries.at(i).pose.value(); }

 private:
  static inline std::unique_ptr<TemporaryDirectory> world_;
};

TEST_F(RegisterApp, FindsEveryScanFromTheOneBefore) {
  const std::string tum = own("poses.tum");
  const std::string text = succeed({"register", scan(0), scan(1), scan(2), world("map.gmap"), "--tum", tum});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_EQ(text.find("scan00.pcd: "), 0u);
  EXPECT_EQ(text.find("degenerate"), std::string::npos);
  const PoseFile found = readPoseFile(tum);
  ASSERT_EQ(found.entries.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT((found.entries[i].pose->translation - truth(i).translation).norm(), 0.02) << i;
}

TEST_F(RegisterApp, TakesAGuess) {
  const Pose pose = truth(1);
  std::vector<std::string> words = {"register", scan(1), world("map.gmap"), "--json", "--guess"};
  for (const double number : {pose.translation.x() + 0.5, pose.translation.y() - 0.5, pose.translation.z(),
                              pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.rotation.w()})
    words.push_back(std::to_string(number));
  const Json said = Json::parse(succeed(words)).at(0);
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(said["translation"][axis].get<double>(), pose.translation[Eigen::Index(axis)], 0.02);
  EXPECT_EQ(said["covariance"].size(), 36u);
  EXPECT_GT(said["covariance"][0], 0.0);
  EXPECT_GT(said["fitness"], 0.5);
  EXPECT_EQ(said["converged"], true);
}

TEST_F(RegisterApp, MovesAMapOntoAMap) {
  const std::string moved = own("moved.gmap");
  succeed({"transform", world("map.gmap"), "-o", moved, "--transform", "0.6 -0.4 0.1 0 0 0.0436194 0.9990482"});
  // The way back: the inverse of what moved it, 5 degrees about z.
  const Json said = Json::parse(succeed({"register", moved, world("map.gmap"), "--json"})).at(0);
  const double cosine = std::cos(5.0 * std::acos(-1.0) / 180.0), sine = std::sin(5.0 * std::acos(-1.0) / 180.0);
  EXPECT_NEAR(said["translation"][0].get<double>(), -(cosine * 0.6 + sine * -0.4), 0.03);
  EXPECT_NEAR(said["translation"][1].get<double>(), -(-sine * 0.6 + cosine * -0.4), 0.03);
  EXPECT_NEAR(said["translation"][2].get<double>(), -0.1, 0.03);
  EXPECT_NEAR(said["quaternion_xyzw"][2].get<double>(), -0.0436194, 0.002);
  EXPECT_GT(said["fitness"], 0.8);
}

/// Writes scan `i` of the hall with another VIEWPOINT.
std::string withViewpoint(const std::string& scan, const std::string& viewpoint) {
  std::ifstream file(scan, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const std::size_t at = bytes.find("VIEWPOINT "), end = bytes.find('\n', at);
  return bytes.replace(at, end - at, "VIEWPOINT " + viewpoint);
}

std::string viewpointOf(const Pose& pose) {
  std::string text;
  for (const double number : {pose.translation.x(), pose.translation.y(), pose.translation.z(), pose.rotation.w(),
                              pose.rotation.x(), pose.rotation.y(), pose.rotation.z()})
    text += (text.empty() ? "" : " ") + std::to_string(number);
  return text;
}

TEST_F(RegisterApp, StartsEachScanAtItsOwnPose) {
  // In this order, the step from one scan to the next is 20 m and more. Each VIEWPOINT is half a metre off.
  std::vector<std::string> words = {"register"};
  const std::vector<std::size_t> order = {0, 12, 3, 16};
  for (const std::size_t i : order) {
    Pose near = truth(i);
    near.translation += Eigen::Vector3d(0.4, -0.3, 0.05);
    const std::string name = "cloud_" + std::to_string(100 + i) + ".25.pcd";
    directory_.write(name, withViewpoint(anyScan(i), viewpointOf(near)));
    words.push_back(own(name));
  }
  words.insert(words.end(), {world("whole.gmap"), "--tum", own("found.tum")});
  succeed(words);
  const PoseFile found = readPoseFile(own("found.tum"));
  ASSERT_EQ(found.entries.size(), order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    EXPECT_LT((found.entries[k].pose->translation - truth(order[k]).translation).norm(), 0.03) << k;
    EXPECT_EQ(std::stod(found.entries[k].name), 100.25 + double(order[k]));  // the number in the name
  }
}

TEST_F(RegisterApp, TakesTheGuessesFromAPoseFile) {
  std::string poses;
  std::vector<std::string> words = {"register"};
  for (const std::size_t i : {2u, 15u, 8u}) {
    const std::string name = "p" + std::to_string(i) + ".pcd";
    directory_.write(name, withViewpoint(anyScan(i), "500 0 0 1 0 0 0"));
    words.push_back(own(name));
    const Pose pose = truth(i);
    poses += name;
    for (const double number : {pose.translation.x() + 0.3, pose.translation.y(), pose.translation.z(),
                                pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.rotation.w()})
      poses += " " + std::to_string(number);
    poses += "\n";
  }
  words.insert(words.end(), {world("whole.gmap"), "--poses", directory_.write("poses.txt", poses).string(), "--json"});
  const Json said = Json::parse(succeed(words));
  std::size_t k = 0;
  for (const std::size_t i : {2u, 15u, 8u}) {
    EXPECT_NEAR(said[k]["translation"][0].get<double>(), truth(i).translation.x(), 0.03);
    EXPECT_NEAR(said[k++]["translation"][1].get<double>(), truth(i).translation.y(), 0.03);
  }
  expectDataError("scan01.pcd (no index 1)", {"register", scan(0), scan(1), world("map.gmap"), "--poses",
                                              directory_.write("one.tum", "0 0 0 0 0 0 0 1\n").string()});
}

TEST_F(RegisterApp, AppliesTheMotionOfTheOwnPosesToTheResultBeforeIfAGuessIsGiven) {
  // The own poses are those of another frame, 100 m away: only their differences are used.
  std::vector<std::string> words = {"register"};
  for (const std::size_t i : {0u, 4u, 8u}) {
    Pose other = truth(i);
    other.translation += Eigen::Vector3d(100, 50, 0);
    directory_.write("m" + std::to_string(i) + ".pcd", withViewpoint(anyScan(i), viewpointOf(other)));
    words.push_back(own("m" + std::to_string(i) + ".pcd"));
  }
  words.insert(words.end(), {world("whole.gmap"), "--json", "--guess"});
  const Pose first = truth(0);
  for (const double number : {first.translation.x(), first.translation.y(), first.translation.z(), first.rotation.x(),
                              first.rotation.y(), first.rotation.z(), first.rotation.w()})
    words.push_back(std::to_string(number));
  const Json said = Json::parse(succeed(words));
  std::size_t k = 0;
  for (const std::size_t i : {0u, 4u, 8u})
    EXPECT_NEAR(said[k++]["translation"][0].get<double>(), truth(i).translation.x(), 0.03) << i;
}

TEST_F(RegisterApp, GoesOnAfterAScanWithoutPoints) {
  directory_.write("s1.pcd", withViewpoint(scan(0), viewpointOf(truth(0))));
  directory_.write("s2.pcd",
                   "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
                   "VIEWPOINT 1 2 1 1 0 0 0\nPOINTS 1\nDATA ascii\nnan nan nan\n");
  directory_.write("s3.pcd", withViewpoint(scan(2), viewpointOf(truth(2))));
  const Outcome outcome =
      runApp({"register", own("s1.pcd"), own("s2.pcd"), own("s3.pcd"), world("map.gmap"), "--tum", own("t.tum")});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2) << outcome.out;
  EXPECT_NE(outcome.err.find("s2.pcd: no usable point\n"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("1 of 3 scans was not registered"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 2) << outcome.err;
  const PoseFile found = readPoseFile(own("t.tum"));
  ASSERT_EQ(found.entries.size(), 2u);
  EXPECT_EQ(found.entries[1].name, "3");
  EXPECT_LT((found.entries[1].pose->translation - truth(2).translation).norm(), 0.02);
  expectDataError("s2.pcd: no usable point", {"register", own("s2.pcd"), world("map.gmap")});
}

TEST_F(RegisterApp, GoesOnAfterADamagedFile) {
  const std::string whole = withViewpoint(scan(1), viewpointOf(truth(1)));
  directory_.write("d1.pcd", withViewpoint(scan(0), viewpointOf(truth(0))));
  directory_.write("d2.pcd", whole.substr(0, whole.size() / 2));
  directory_.write("d3.pcd", withViewpoint(scan(2), viewpointOf(truth(2))));
  for (const std::vector<std::string>& order :
       {std::vector<std::string>{"d1.pcd", "d2.pcd", "d3.pcd"}, {"d2.pcd", "d1.pcd", "d3.pcd"}}) {
    std::vector<std::string> words = {"register"};
    for (const std::string& name : order) words.push_back(own(name));
    words.insert(words.end(), {world("map.gmap"), "--tum", own("t.tum"), "--force"});
    const Outcome outcome = runApp(words);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2) << outcome.out;
    EXPECT_NE(outcome.err.find("gaussmap: " + own("d2.pcd") + ": "), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("1 of 3 scans was not registered"), std::string::npos) << outcome.err;
    const PoseFile found = readPoseFile(own("t.tum"));
    ASSERT_EQ(found.entries.size(), 2u);
    EXPECT_LT((found.entries[0].pose->translation - truth(0).translation).norm(), 0.02);
    EXPECT_LT((found.entries[1].pose->translation - truth(2).translation).norm(), 0.02);
  }
  expectDataError("d2.pcd: ", {"register", own("d2.pcd"), world("map.gmap")});
}

TEST_F(RegisterApp, SaysThatAPoseMayBeWrongWhenLittleOfTheScanLiesOnTheMap) {
  const Pose pose = truth(0);  // the wrong end of the hall
  const Outcome outcome =
      runApp({"register", scan(0), world("map.gmap"), "--json", "--guess", std::to_string(pose.translation.x() + 9.0),
              std::to_string(pose.translation.y() + 6.0), "1.5", "0", "0", "0.7071068", "0.7071068"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const double fitness = Json::parse(outcome.out)[0]["fitness"];
  EXPECT_EQ(outcome.err.find("of the scan lies on the map, so the pose may be wrong") != std::string::npos,
            fitness < 0.35)
      << fitness << outcome.err;
}

TEST_F(RegisterApp, SaysWhatIsWrong) {
  expectUsageError("inputs", {"register"});
  expectUsageError("inputs", {"register", scan(0)});
  expectUsageError("guess", {"register", scan(0), world("map.gmap"), "--guess", "1", "2"});
  expectUsageError("quaternion",
                   {"register", scan(0), world("map.gmap"), "--guess", "0", "0", "0", "0", "0", "0", "0"});
  expectUsageError("check the order of its numbers, or give more digits",
                   {"register", scan(0), world("map.gmap"), "--guess", "9", "-9", "2", "0", "0", "0.19", "0.98"});
  expectDataError("none.gmap", {"register", scan(0), own("none.gmap")});
  expectDataError("none.pcd", {"register", own("none.pcd"), world("map.gmap")});
  expectDataError("no part of the scan lies on the map after the search",
                  {"register", scan(0), world("map.gmap"), "--guess", "9000", "0", "0", "0", "0", "0", "1"});
  directory_.write("there.tum", "mine");
  expectUsageError("there.tum", {"register", scan(0), world("map.gmap"), "--tum", own("there.tum")});
}

}  // namespace
}  // namespace gaussmap::test
