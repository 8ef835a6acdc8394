// SPDX-License-Identifier: BSD-3-Clause
// gaussmap pcd2map --planar, and logs of CARMEN as scans, through the real program.
#include <cmath>

#include "apps/planar_fixture.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"
#include "io/logs/gzip.h"
#include "io/pcd/removed_pcd.h"

namespace gaussmap::test {
namespace {

using PlanarBuild = PlanarApps;

/// A hall in space, scanned at height 1.5 m, made once.
class PlanarSlice : public AppTest {
 protected:
  using Words = std::vector<std::string>;
  static Words joined(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  static void SetUpTestSuite() {
    hall_ = std::make_unique<TemporaryDirectory>();
    ASSERT_EQ(runApp({"simulate", "hall", "-o", hall("hall"), "--scans", "6", "--columns", "360"}).code, 0);
  }
  static void TearDownTestSuite() { hall_.reset(); }
  static std::string hall(const std::string& name) { return (hall_->path() / name).string(); }
  static std::string scans() { return hall("hall/scans"); }

  /// Returns the points of all scans with these heights.
  static std::vector<Vector<2>> pointsBetween(double low, double high) {
    std::vector<Vector<2>> points;
    const FoundScans found = findScans({scans()});
    for (std::size_t i = 0; i < found.scans.size(); ++i) {
      const Scan scan = found.scans.read(i);
      for (const Eigen::Vector3d& point : scan.points) {
        const Eigen::Vector3d in_map = scan.pose * point;
        if (isReturn(point) && in_map.z() >= low && in_map.z() <= high) points.emplace_back(in_map.head<2>());
      }
    }
    return points;
  }

 private:
  static inline std::unique_ptr<TemporaryDirectory> hall_;
};

TEST_F(PlanarBuild, MakesTheSameBytesOfALogOfPcdFilesAndOfARecording) {
  world_->write("room.mcap", PlanarRoom::recording(kScans, kWithPost));
  succeed(planar({world("pcd"), "-o", own("pcd.gmap")}));
  succeed(planar({world("room.mcap"), "-o", own("mcap.gmap")}));
  EXPECT_TRUE(contentsOf(own("pcd.gmap")) == contentsOf(room()));
  EXPECT_TRUE(contentsOf(own("mcap.gmap")) == contentsOf(room()));
}

TEST_F(PlanarBuild, FindsEveryPointInThePlane) {
  const GaussianMapQuadtree map = load<2>(room());
  const double points = (PlanarRoom::kBeams - 1) * kScans;
  for (int s = 0; s < map.scales(); ++s) EXPECT_EQ(map.weight(s), points);
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) {
    const Vector<2> mean = map.gaussian(i, 0).mean;
    const bool on_wall = std::abs(std::abs(mean.x()) - 4.0) < 0.05 || std::abs(std::abs(mean.y()) - 3.0) < 0.05;
    const bool on_post = std::max(std::abs(mean.x() - 2.0), std::abs(mean.y())) < 0.31;
    EXPECT_TRUE(on_wall || on_post) << mean.transpose();
  }
}

TEST_F(PlanarBuild, ReadsALogByItsContentPlainOrCompressed) {
  directory_.write("room", PlanarRoom::log(kScans, kWithPost));
  directory_.write("room.gz", gzipped(PlanarRoom::log(kScans, kWithPost)));
  for (const char* const name : {"room", "room.gz"}) {
    succeed(planar({own(name), "-o", own("map.gmap"), "--force"}));
    EXPECT_TRUE(contentsOf(own("map.gmap")) == contentsOf(room())) << name;
  }
}

TEST_F(PlanarBuild, ListsTheSweepsOfALogWithPosesAndTimes) {
  const Json said = Json::parse(succeed({"scans", world("room.log"), "--json"}));
  ASSERT_EQ(said["scans"].size(), std::size_t{kScans});
  EXPECT_EQ(said["points"]["read"], PlanarRoom::kBeams * kScans);
  EXPECT_EQ(said["points"]["non_finite"], kScans);
  EXPECT_EQ(said["poses"], "pose of the laser in each line of the log");
  const Json& scan = said["scans"][3];
  EXPECT_EQ(scan["kind"], "CARMEN log");
  EXPECT_EQ(scan["scan"], "scan 3");
  EXPECT_EQ(scan["time"], 101.5);
  EXPECT_EQ(scan["translation"][0], PlanarRoom::pose(3).translation.x());
  EXPECT_NEAR(scan["quaternion_xyzw"][2], PlanarRoom::pose(3).rotation.z(), 1e-12);
}

TEST_F(PlanarBuild, WarnsOfDamagedLinesAndOfNothingElse) {
  directory_.write("room.log", "FLASER 3 1 2\n" + PlanarRoom::log(4));
  const Outcome outcome = runApp(planar({own("room.log"), "-o", own("map.gmap")}));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.err.find("warning: " + own("room.log") + ": line 1 is left out: the number of ranges is 3"),
            std::string::npos)
      << outcome.err;
  directory_.write("empty.log", "PARAM a 1\n");
  expectDataError("has no usable scan of a planar laser", planar({own("empty.log"), "-o", own("no.gmap")}));
}

TEST_F(PlanarBuild, TakesOtherPosesForTheScansOfALog) {
  directory_.write("one.log", "# a room\n" + PlanarRoom::line(0, false));
  directory_.write("poses.tum",
                   "99.5 5 5 5 0 0 0 1\n100.0001 8.5 0 0 0 0 0 1\n");  // by time; 10 m beside the log's own pose
  succeed(planar({own("one.log"), "-o", own("own.gmap")}));
  succeed(planar({own("one.log"), "-o", own("moved.gmap"), "--poses", own("poses.tum"), "--match-poses", "time"}));
  const Json at = infoOf(own("own.gmap"))["extent"], moved = infoOf(own("moved.gmap"))["extent"];
  EXPECT_NEAR(moved["low"][0].get<double>(), at["low"][0].get<double>() + 10.0, 1e-9);
  EXPECT_EQ(moved["high"][1], at["high"][1]);
}

TEST_F(PlanarBuild, WithinMemoryMakesTheSameFile) {
  succeed(planar({world("room.log"), "-o", own("memory.gmap"), "--no-curves"}));
  succeed(planar({world("room.log"), "-o", own("within.gmap"), "--max-memory", "2M"}));
  EXPECT_TRUE(contentsOf(own("memory.gmap")) == contentsOf(own("within.gmap")));
}

TEST_F(PlanarBuild, CropsToABoxInThePlane) {
  succeed(planar({world("room.log"), "-o", own("part.gmap"), "--crop", "0", "-10", "10", "10"}));
  const Json extent = infoOf(own("part.gmap"))["extent"];
  EXPECT_GE(extent["low"][0], 0.0);
  expectUsageError("--crop: a planar map has no heights",
                   planar({world("room.log"), "-o", own("no.gmap"), "--crop", "0", "0", "0", "1", "1", "1"}));
}

TEST_F(PlanarBuild, AddsScansToAMapWhoseFileTellsItsDimension) {
  directory_.write("first.log", "# a room\n" + PlanarRoom::line(0, true));
  std::string rest = "# a room\n";
  for (int i = 1; i < kScans; ++i) rest += PlanarRoom::line(i, i < kWithPost);
  directory_.write("rest.log", rest);
  succeed(planar({own("first.log"), "-o", own("map.gmap")}));
  const std::string said = succeed({"pcd2map", "--update", own("map.gmap"), own("rest.log")});
  EXPECT_NE(said.find("23 scans"), std::string::npos) << said;
  const GaussianMapQuadtree all = load<2>(room()), map = load<2>(own("map.gmap"));
  EXPECT_TRUE(all.scale(0).keys == map.scale(0).keys);
  EXPECT_TRUE(all.scale(0).moments == map.scale(0).moments);
  const std::string space = world("space.gmap");
  expectUsageError("--planar: " + space + " is a 3-D map", {"pcd2map", "--planar", "--update", space, own("rest.log")});
  expectUsageError("--slice: " + space + " is a 3-D map",
                   {"pcd2map", "--slice", "0", "1", "--update", space, own("rest.log")});
}

TEST_F(PlanarBuild, OnlineDeletesThePostThatLeftAndRestoresIt) {
  const Words online = planar({"--online", world("room.log"), "--refine-every", "4"});
  succeed(joined(online, {"-o", own("map.gmap"), "--removed", own("removed.pcd"), "--stats", own("stats.csv")}));
  succeed(joined(online, {"-o", own("keep.gmap"), "--keep"}));
  const auto isPost = [](const Vector<2>& p) { return std::max(std::abs(p.x() - 2.0), std::abs(p.y())) < 0.35; };
  const auto postOf = [&](const std::string& path) {
    const GaussianMapQuadtree map = load<2>(path);
    double weight = 0.0;
    for (std::size_t i = 0; i < map.gaussianCount(0); ++i)
      if (isPost(map.gaussian(i, 0).mean)) weight += map.gaussian(i, 0).weight;
    return weight;
  };
  EXPECT_GT(postOf(own("keep.gmap")), 30.0);
  EXPECT_LT(postOf(own("map.gmap")), 0.1 * postOf(own("keep.gmap")));
  EXPECT_EQ(infoOf(own("map.gmap"))["occupancy"], true);
  // Without deletion, the finest scale is that of the map of all scans.
  EXPECT_TRUE(load<2>(own("keep.gmap")).scale(0).moments == load<2>(room()).scale(0).moments);

  succeed({"restore", own("map.gmap"), own("removed.pcd"), "-o", own("whole.gmap")});
  EXPECT_TRUE(load<2>(own("whole.gmap")).scale(0).moments == load<2>(room()).scale(0).moments);
  succeed({"restore", own("map.gmap"), own("removed.pcd"), "-o", own("post.gmap"), "--box", "1", "-1", "3", "1"});
  EXPECT_EQ(postOf(own("post.gmap")), postOf(own("keep.gmap")));
  expectUsageError("--box: a planar map has no heights", {"restore", own("map.gmap"), own("removed.pcd"), "-o",
                                                          own("no.gmap"), "--box", "1", "-1", "0", "3", "1", "1"});
}

TEST_F(PlanarSlice, HoldsThePointsBetweenTheHeights) {
  succeed({"pcd2map", "--planar", "--slice", "1", "2", scans(), "-o", own("slice.gmap"), "--budget", "1"});
  const std::vector<Vector<2>> points = pointsBetween(1.0, 2.0);
  const GaussianMapQuadtree map = load<2>(own("slice.gmap")), expected = build<2>(points, MapOptions());
  ASSERT_GT(points.size(), 1000u);
  EXPECT_TRUE(map.scale(0).keys == expected.scale(0).keys);
  EXPECT_EQ(map.weight(0), static_cast<double>(points.size()));
  const Json step = infoOf(own("slice.gmap"))["metadata"]["history"].back();
  EXPECT_EQ(step["slice"], Json({1.0, 2.0}));
}

TEST_F(PlanarSlice, IsNeededForScansInSpace) {
  const Words build = {"pcd2map", "--planar", scans(), "-o", own("map.gmap")};
  expectDataError("use a slice of it (--slice Z0 Z1)", build);
  expectDataError("scan00.pcd: not a scan of a planar laser", joined(build, {"--online"}));
  expectDataError("(--slice Z0 Z1)", joined(build, {"--max-memory", "10M"}));
  expectDataError("outside --slice", joined(build, {"--slice", "50", "60"}));
  expectDataError("no point lies between the heights of --slice", joined(build, {"--online", "--slice", "50", "60"}));
  expectUsageError("--slice: only for planar maps; add --planar",
                   {"pcd2map", scans(), "-o", own("map.gmap"), "--slice", "1", "2"});
  expectUsageError("--slice: the second height is below the first", joined(build, {"--slice", "2", "1"}));
}

TEST_F(PlanarSlice, OnlineUsesTheNearestPointOfEveryDirection) {
  const std::string said = succeed(
      {"pcd2map", "--planar", "--online", "--slice", "1", "2", scans(), "-o", own("map.gmap"), "--resolution", "0.2"});
  EXPECT_NE(said.find("6 scans"), std::string::npos) << said;
  EXPECT_EQ(said.find("left out"), std::string::npos) << "beams without a point are not points: " << said;
  const Json info = infoOf(own("map.gmap"));
  EXPECT_EQ(info["occupancy"], true);
  EXPECT_GT(info["scales"][0]["weight"], 6 * 300.0);
  EXPECT_LE(info["scales"][0]["weight"], 6 * 720.0);  // beams of half a degree
}

/// Returns the RMS distance of the mass of the Gaussians of a scale from the walls of a room of 8 m x 6 m.
template <int D>
double errorAtTheWalls(const GaussianMap<D>& map, int scale) {
  double sum = 0.0, weight = 0.0;
  for (std::size_t i = 0; i < map.gaussianCount(scale); ++i) {
    const Gaussian<D> one = map.gaussian(i, scale);
    const double to_x = 4.0 - std::abs(one.mean.x()), to_y = 3.0 - std::abs(one.mean.y());
    const int axis = std::abs(to_x) < std::abs(to_y) ? 0 : 1;
    const double distance = axis == 0 ? to_x : to_y;
    sum += one.weight * (distance * distance + one.cov(axis, axis));
    weight += one.weight;
  }
  return std::sqrt(sum / weight);
}

TEST_F(PlanarSlice, IsAsAccurateAtTheWallsAsTheMapInSpace) {
  std::filesystem::create_directories(own("scans"));
  for (int i = 0; i < 4; ++i) {
    Random random(static_cast<std::uint64_t>(i));
    Pose pose;
    pose.translation = {0.5 * i - 1.0, 0.3, 1.0};
    std::vector<Vector<3>> points;
    for (int ring = -8; ring <= 8; ++ring)
      for (int column = 0; column < 720; ++column) {
        const double angle = (column + 0.5) * 0.5 * std::acos(-1.0) / 180.0, dx = std::cos(angle), dy = std::sin(angle);
        const double range = std::min(((dx < 0 ? -4.0 : 4.0) - pose.translation.x()) / dx,
                                      ((dy < 0 ? -3.0 : 3.0) - pose.translation.y()) / dy);
        const double noise = 0.02 * (random.uniform() + random.uniform() + random.uniform() - 1.5) * 2.0;
        const Vector<3> direction(dx, dy, 0.02 * ring);
        points.emplace_back(direction * (range + noise));
      }
    writePcd(own("scans/scan" + std::to_string(i) + ".pcd"), points, PcdPrecision::Double, pose);
  }
  const Words more = {"--resolution", "0.2", "--noise", "0.001"};
  succeed(joined({"pcd2map", "--planar", "--slice", "0.8", "1.2", own("scans"), "-o", own("slice.gmap")}, more));
  succeed(
      joined({"pcd2map", own("scans"), "-o", own("space.gmap"), "--crop", "-9", "-9", "0.8", "9", "9", "1.2"}, more));
  const GaussianMapQuadtree slice = load<2>(own("slice.gmap"));
  const GaussianMapOctree space = load(own("space.gmap"));
  ASSERT_EQ(slice.weight(0), space.weight(0));
  for (int s = 0; s < slice.scales(); ++s) EXPECT_LT(errorAtTheWalls(slice, s), 1.1 * errorAtTheWalls(space, s)) << s;
}

}  // namespace
}  // namespace gaussmap::test
