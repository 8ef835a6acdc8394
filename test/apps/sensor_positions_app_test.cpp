// SPDX-License-Identifier: BSD-3-Clause
// Commands that follow the rays of the sensor, with scans that do not say where the sensor was.
#include <cmath>

#include "apps/app_fixture.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"

namespace gaussmap::test {
namespace {

class SensorPositions : public AppTest {
 protected:
  static void SetUpTestSuite() {
    world_ = std::make_unique<TemporaryDirectory>();
    succeed(
        {"simulate", "street", "-o", world("street"), "--moving", "--scans", "7", "--rings", "16", "--columns", "300"});
    const FoundScans found = findScans({world("street/scans")});
    std::filesystem::create_directory(world("moved"));
    std::filesystem::create_directory(world("still"));
    std::vector<Vector<3>> all;
    for (std::size_t i = 0; i < found.scans.size(); ++i) {
      const Scan scan = found.scans.read(i);
      std::vector<Vector<3>> in_map;
      for (const Eigen::Vector3d& point : scan.points) in_map.push_back(scan.pose * point);
      writePcd(world("moved/" + std::to_string(i) + ".pcd"), in_map);
      all.insert(all.end(), in_map.begin(), in_map.end());
    }
    writePcd(world("merged.pcd"), all);
    // A sensor that stands still at 30 20 1: a box before the wall is there in the first two scans.
    for (int i = 0; i < 8; ++i) writePcd(world("still/" + std::to_string(i) + ".pcd"), standing(i));
  }
  static void TearDownTestSuite() { world_.reset(); }
  static std::string world(const std::string& name) { return (world_->path() / name).string(); }

  static std::vector<Vector<3>> standing(int scan) {
    std::vector<Vector<3>> points;
    for (int ring = -8; ring <= 8; ++ring)
      for (int column = 0; column < 360; ++column) {
        const double azimuth = (column + 0.5) * std::acos(-1.0) / 180.0;
        const Eigen::Vector3d ray(std::cos(azimuth), std::sin(azimuth), std::tan(0.03 * ring));
        double range = std::min(6.0 / std::abs(ray.x()), 4.0 / std::abs(ray.y()));
        if (scan < 2 && ray.x() > 0.97) range = 3.0 / ray.x();
        points.emplace_back((range + 0.01 * std::sin(7.0 * column + ring + scan)) * ray + Eigen::Vector3d(30, 20, 1));
      }
    return points;
  }

 private:
  static inline std::unique_ptr<TemporaryDirectory> world_;
};

TEST_F(SensorPositions, AreAskedForWhenCloudsInTheMapFrameHaveNone) {
  expectDataError("all scans have the sensor position (0 0 0), but their points show that the sensor moved",
                  {"clean", world("moved"), "--frame", "map", "-o", own("c")});
  expectDataError(
      ". The command clean follows the rays from the sensor to the points: give the poses of the sensor "
      "with --poses FILE\n",
      {"clean", world("moved"), "--frame", "map", "-o", own("c")});
  expectDataError(". The option --online follows the rays",
                  {"pcd2map", world("moved"), "--frame", "map", "--online", "-o", own("m.gmap")});
}

TEST_F(SensorPositions, AreAskedForWhenNothingSaysWhichFrameItIs) {
  expectDataError("--poses FILE, and --frame map if", {"clean", world("moved"), "-o", own("c")});
}

TEST_F(SensorPositions, FromAPoseFileAreEnough) {
  succeed({"clean", world("moved"), "--frame", "map", "--poses", world("street/trajectory.tum"), "-o", own("c")});
  succeed({"pcd2map", world("moved"), "--frame", "map", "--poses", world("street/trajectory.tum"), "--online", "-o",
           own("m.gmap"), "--resolution", "0.3"});
}

TEST_F(SensorPositions, AreNotNeededForAMapWithoutOccupancy) {
  succeed({"pcd2map", world("moved"), "--frame", "map", "-o", own("m.gmap"), "--resolution", "0.3"});
}

TEST_F(SensorPositions, MayBeEqualIfTheSensorStandsStill) {
  std::string poses;
  for (int i = 0; i < 8; ++i) poses += std::to_string(i) + " 30 20 1 0 0 0 1\n";
  const std::string file = directory_.write("still.tum", poses).string();
  const std::string said =
      succeed({"clean", world("still"), "--frame", "map", "--poses", file, "--json", "-o", own("c")});
  EXPECT_GT(Json::parse(said)["removed"], 300);  // most of 2 scans x 17 rings x 28 columns
  succeed({"pcd2map", world("still"), "--frame", "map", "--poses", file, "--online", "-o", own("m.gmap")});
}

TEST_F(SensorPositions, CannotBeRecoveredFromAMergedCloud) {
  expectDataError("merged.pcd: one cloud alone shows no motion", {"clean", world("merged.pcd"), "-o", own("c")});
  expectDataError("merged.pcd: one cloud alone shows no motion",
                  {"clean", world("merged.pcd"), "--frame", "map", "--labels", "label"});
}

}  // namespace
}  // namespace gaussmap::test
