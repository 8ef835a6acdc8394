// SPDX-License-Identifier: BSD-3-Clause
// gaussmap register through the real program.
#include <cmath>

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
  }
  static void TearDownTestSuite() { world_.reset(); }
  static std::string world(const std::string& name) { return (world_->path() / name).string(); }
  static std::string scan(int i) { return world("hall/scans/scan0" + std::to_string(i) + ".pcd"); }
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

TEST_F(RegisterApp, SaysWhatIsWrong) {
  expectUsageError("inputs", {"register"});
  expectUsageError("inputs", {"register", scan(0)});
  expectUsageError("guess", {"register", scan(0), world("map.gmap"), "--guess", "1", "2"});
  expectUsageError("quaternion",
                   {"register", scan(0), world("map.gmap"), "--guess", "0", "0", "0", "0", "0", "0", "0"});
  expectDataError("none.gmap", {"register", scan(0), own("none.gmap")});
  expectDataError("none.pcd", {"register", own("none.pcd"), world("map.gmap")});
  expectDataError("no part of it lies on the map",
                  {"register", scan(0), world("map.gmap"), "--guess", "9000", "0", "0", "0", "0", "0", "1"});
  directory_.write("there.tum", "mine");
  expectUsageError("there.tum", {"register", scan(0), world("map.gmap"), "--tum", own("there.tum")});
}

}  // namespace
}  // namespace gaussmap::test
