// SPDX-License-Identifier: BSD-3-Clause
// gaussmap simulate: scans, their truth, and what an earlier run left.
#include <cmath>
#include <numeric>

#include "apps/app_fixture.h"
#include "gaussmap/io/mesh/ply.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/io/scans/pose_file.h"
#include "mesh/mesh_distance.h"

namespace gaussmap::test {
using namespace detail;

namespace {

namespace fs = std::filesystem;
using Points = std::vector<Vector<3>>;

class SimulateApp : public AppTest {
 protected:
  /// Makes small scans in the directory `name`.
  std::string simulate(const std::string& name, std::vector<std::string> options) const {
    options.insert(options.begin(), {"simulate", "-o", own(name)});
    return succeed(options);
  }
  std::vector<fs::path> scans(const std::string& name) const { return listScans({own(name) + "/scans"}); }

  static Points pointsOf(const PcdReader& reader) {
    const auto columns = reader.columns({{"x", 0}, {"y", 0}, {"z", 0}});
    Points points;
    for (std::size_t i = 0; i < reader.size(); ++i) points.emplace_back(columns[0][i], columns[1][i], columns[2][i]);
    return points;
  }

  /// Without noise: VIEWPOINT takes every point of a scan to its point of truth.pcd, which lies on truth.ply, and
  /// trajectory.tum has the poses.
  void expectExactTruth(const std::string& name) const {
    const Points truth = pointsOf(PcdReader(own(name + "/truth.pcd")));
    const PoseFile poses = readPoseFile(own(name + "/trajectory.tum"));
    const std::vector<fs::path> paths = scans(name);
    ASSERT_EQ(poses.entries.size(), paths.size());
    std::size_t next = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const PcdReader reader(paths[i]);
      const Pose pose = normalised(reader.header().viewpoint);
      EXPECT_LT((pose.translation - poses.entries[i].pose->translation).norm(), 1e-6);
      EXPECT_LT(pose.rotation.angularDistance(poses.entries[i].pose->rotation), 1e-6);
      for (const Vector<3>& point : pointsOf(reader)) {
        ASSERT_LT(next, truth.size());
        ASSERT_LT((pose * point - truth[next++]).norm(), 2e-5);  // floats up to 80 m
      }
    }
    EXPECT_EQ(next, truth.size());
    for (const double distance : meshDistances(truth, readPly(own(name + "/truth.ply")))) ASSERT_LT(distance, 1e-6);
  }
};

TEST_F(SimulateApp, WritesScansOfEverySceneThatLieOnItsMesh) {
  for (const std::string scene : {"corner", "street", "avenue", "hall"}) {
    SCOPED_TRACE(scene);
    const std::string text =
        simulate(scene, {scene, "--scans", "3", "--rings", "8", "--columns", "40", "--noise", "0"});
    EXPECT_NE(text.find(scene + ", 3 scans, "), std::string::npos) << text;
    EXPECT_EQ(scans(scene).size(), 3u);
    expectExactTruth(scene);
  }
}

TEST_F(SimulateApp, ScansThePlanWithAPlanarLaser) {
  simulate("plan", {"plan", "--scans", "4", "--columns", "91", "--field-of-view", "90", "--noise", "0"});
  expectExactTruth("plan");
  for (const fs::path& scan : scans("plan")) {
    const Points points = pointsOf(PcdReader(scan));
    EXPECT_GT(points.size(), 80u);
    for (const Vector<3>& point : points) {
      EXPECT_EQ(point.z(), 0.0);
      EXPECT_LE(std::abs(std::atan2(point.y(), point.x())), (45.0 + 1e-4) * std::acos(-1.0) / 180.0);
    }
  }
  succeed({"pcd2map", own("plan/scans"), "-o", own("plan.gmap")});
  EXPECT_EQ(infoOf(own("plan.gmap"))["scales"][2]["weight"], PcdReader(own("plan/truth.pcd")).size());
}

TEST_F(SimulateApp, LabelsWhatMovesAndLeavesItOutOfTheTruth) {
  const std::string text = simulate("moving", {"street", "--moving", "--rings", "16", "--columns", "180"});
  std::size_t points = 0;
  double moving = 0.0;
  for (const fs::path& scan : scans("moving")) {
    const PcdReader reader(scan);
    const std::vector<double> labels = reader.column("label");
    for (const double label : labels) ASSERT_TRUE(label == 0.0 || label == 1.0) << label;
    moving += std::accumulate(labels.begin(), labels.end(), 0.0);
    points += reader.size();
  }
  const auto count = static_cast<std::size_t>(moving);
  EXPECT_GT(count, 0u);
  EXPECT_LT(count, points / 5);
  EXPECT_EQ(PcdReader(own("moving/truth.pcd")).size(), points - count);
  EXPECT_NE(text.find(" (" + std::to_string(count) + " on moving objects)"), std::string::npos) << text;

  simulate("still", {"street", "--scans", "1", "--rings", "4", "--columns", "20"});
  EXPECT_EQ(PcdReader(scans("still").front()).header().find("label"), nullptr);
}

TEST_F(SimulateApp, WritesTheSameScansForTheSameSeed) {
  simulate("a", {"--rings", "4", "--columns", "20"});
  simulate("b", {"--rings", "4", "--columns", "20", "--threads", "2"});
  simulate("c", {"--rings", "4", "--columns", "20", "--seed", "2"});
  for (const std::string name : {"/scans/scan00.pcd", "/scans/scan04.pcd"}) {
    EXPECT_EQ(contentsOf(own("a" + name)), contentsOf(own("b" + name)));
    EXPECT_NE(contentsOf(own("a" + name)), contentsOf(own("c" + name)));
  }
  EXPECT_EQ(contentsOf(own("a/truth.pcd")), contentsOf(own("b/truth.pcd")));
}

TEST_F(SimulateApp, RefusesOptionsThatDoNotSuitTheScene) {
  expectUsageError("--moving", {"simulate", "hall", "--moving", "-o", own("x")});
  expectUsageError("--rings", {"simulate", "plan", "--rings", "8", "-o", own("x")});
  expectUsageError("--field-of-view", {"simulate", "street", "--field-of-view", "90", "-o", own("x")});
  expectUsageError("castle", {"simulate", "castle", "-o", own("x")});
  expectUsageError("--scans", {"simulate", "--scans", "0", "-o", own("x")});
}

TEST_F(SimulateApp, NeverMixesScansOfAnEarlierRunIntoItsOwn) {
  const std::vector<std::string> size = {"--rings", "2", "--columns", "10"};
  const auto arguments = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"simulate", "-o", own("world")});
    more.insert(more.end(), size.begin(), size.end());
    return more;
  };
  succeed(arguments({"--scans", "7"}));
  const std::string before = contentsOf(own("world/scans/scan00.pcd"));
  expectUsageError("exists already", arguments({"--scans", "3"}));
  // --force replaces what has the same name; the longer run's scans 3 to 6 would be left.
  expectUsageError("would lie among the new scans", arguments({"--scans", "3", "--seed", "2", "--force"}));
  expectUsageError("would lie among", arguments({"--scans", "101", "--force"}));  // these are scan000.pcd ...
  EXPECT_EQ(contentsOf(own("world/scans/scan00.pcd")), before);
  for (const char* const name : {"scan03.pcd", "scan04.pcd", "scan05.pcd"}) fs::remove(own("world/scans/") + name);
  fs::rename(own("world/scans/scan06.pcd"), own("world/scans/SCAN06.PCD"));  // a scan for pcd2map, too
  expectUsageError("SCAN06.PCD would lie among", arguments({"--scans", "3", "--force"}));
  fs::remove(own("world/scans/SCAN06.PCD"));
  directory_.write("world/scans/notes.txt", "mine");
  succeed(arguments({"--scans", "3", "--seed", "2", "--force"}));
  EXPECT_EQ(scans("world").size(), 3u);
  EXPECT_NE(contentsOf(own("world/scans/scan00.pcd")), before);
  EXPECT_EQ(readPoseFile(own("world/trajectory.tum")).entries.size(), 3u);
}

}  // namespace
}  // namespace gaussmap::test
