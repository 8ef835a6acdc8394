// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/segments/laser_scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "gaussmap/io/scans/file_scans.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

constexpr double kPi = 3.14159265358979323846, kDegree = kPi / 180.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Vector<3> polar(double degrees, double range, double height = 0.0) {
  return {range * std::cos(degrees * kDegree), range * std::sin(degrees * kDegree), height};
}

class PlanarScanTest : public testing::Test {
 protected:
  LaserScan read(const std::vector<Vector<3>>& points, const Pose& pose = {}, const PlanarScanOptions& options = {},
                 ScanFrame frame = ScanFrame::Sensor) {
    const std::filesystem::path path = directory_.path() / "scan.pcd";
    writePcd(path, points, PcdPrecision::Double, pose);
    return planarScans(FileScans({{path, pose}}, frame), options).front();
  }
  static void expectBeams(const LaserScan& scan, const std::vector<double>& degrees,
                          const std::vector<double>& ranges) {
    ASSERT_EQ(scan.bearings.size(), degrees.size());
    ASSERT_EQ(scan.ranges.size(), ranges.size());
    for (std::size_t i = 0; i < degrees.size(); ++i) {
      EXPECT_NEAR(scan.bearings[i] / kDegree, degrees[i], 1e-9) << i;
      if (std::isnan(ranges[i])) {
        EXPECT_FALSE(scan.returned(i)) << i;
      } else {
        EXPECT_NEAR(scan.ranges[i], ranges[i], 1e-9) << i;
      }
    }
  }

  test::TemporaryDirectory directory_;
};

Pose posed(double x, double y, double z, double yaw_degrees,
           const Eigen::AngleAxisd& more = {0.0, Eigen::Vector3d::UnitX()}) {
  return {{x, y, z}, Pose::Rotation(Eigen::AngleAxisd(yaw_degrees * kDegree, Eigen::Vector3d::UnitZ()) * more)};
}

TEST_F(PlanarScanTest, KeepsTheBeamsOfAPlanarLaserWithThePoseOfTheFile) {
  const LaserScan scan = read({polar(-90, 1), polar(-30, 2), polar(30, 3), polar(90, 4)}, posed(5, -6, 0.4, 30));
  expectBeams(scan, {-90, -30, 30, 90}, {1, 2, 3, 4});
  EXPECT_EQ(scan.pose.translation, Vector<2>(5, -6));
  EXPECT_NEAR(scan.pose.heading, 30 * kDegree, 1e-12);
  EXPECT_TRUE(scan.pose.covariance.isZero(0.0));
  EXPECT_NEAR((scan.hit(1) - Vector<2>(5 + 2, -6)).norm(), 0.0, 1e-9);
}

TEST_F(PlanarScanTest, GivesBeamsWithoutReturnTheBearingBetweenTheirNeighbours) {
  const Vector<3> none = Vector<3>::Constant(kNan);
  const LaserScan scan = read({none, polar(0, 1), none, none, polar(3, 2), polar(4, 2), none});
  expectBeams(scan, {0, 1, 2, 3, 4}, {1, kNan, kNan, 2, 2});
}

TEST_F(PlanarScanTest, TakesThePlaceOfTheSensorForNoReturn) {
  expectBeams(read({polar(0, 1), Vector<3>::Zero(), polar(2, 2)}), {0, 1, 2}, {1, kNan, 2});
}

TEST_F(PlanarScanTest, PutsABeamWithoutReturnWhereTheFileLeftBeamsOut) {
  expectBeams(read({polar(0, 1), polar(1, 1), polar(2, 1), polar(6, 1), polar(7, 1)}), {0, 1, 2, 4, 6, 7},
              {1, 1, 1, kNan, 1, 1});
}

TEST_F(PlanarScanTest, OrdersBeamsByTheirBearings) {
  expectBeams(read({polar(3, 3), polar(2, 2), polar(1, 1)}), {1, 2, 3}, {1, 2, 3});  // clockwise
  expectBeams(read({polar(2, 2), polar(1, 1), polar(3, 3)}), {1, 2, 3}, {1, 2, 3});  // in no order
  expectBeams(read({polar(178, 1), polar(179, 2), polar(-180, 3), polar(-179, 4)}), {178, 179, 180, 181}, {1, 2, 3, 4});
}

TEST_F(PlanarScanTest, TakesAFullTurnFromWhereverItBegins) {
  std::vector<Vector<3>> points;
  std::vector<double> degrees, ranges;
  for (int i = 0; i < 360; ++i) {
    points.push_back(polar(90 + i, 1 + i));
    degrees.push_back(90 + i);
    ranges.push_back(1 + i);
  }
  expectBeams(read(points), degrees, ranges);
}

TEST_F(PlanarScanTest, LeavesOutTheRangesBeyondTheLimit) {
  PlanarScanOptions options;
  options.max_range = 2.0;
  expectBeams(read({polar(0, 1), polar(1, 2.5), polar(2, 2)}, {}, options), {0, 1, 2}, {1, kNan, 2});
}

TEST_F(PlanarScanTest, TakesPointsThatAreInTheMapFrameAlready) {
  const Pose pose = posed(1, 2, 0, 90);
  const LaserScan scan =
      read({Vector<3>(1, 2, 0) + polar(90, 3), Vector<3>(1, 2, 0) + polar(91, 4)}, pose, {}, ScanFrame::Map);
  expectBeams(scan, {0, 1}, {3, 4});
}

TEST_F(PlanarScanTest, IsExactFarFromTheOrigin) {
  const LaserScan scan = read({polar(0, 1.25), polar(1, 2.5)}, posed(1e7, -1e7, 0, 45));
  expectBeams(scan, {0, 1}, {1.25, 2.5});
}

TEST_F(PlanarScanTest, HandlesScansWithoutAndWithOneReturn) {
  EXPECT_TRUE(read({}).ranges.empty());
  EXPECT_TRUE(read({Vector<3>::Constant(kNan), Vector<3>::Zero()}).ranges.empty());
  expectBeams(read({polar(12, 3)}), {12}, {3});
  expectBeams(read({polar(12, 3), polar(12, 3), polar(12, 4)}), {12, 12, 12}, {3, 3, 4});
}

TEST_F(PlanarScanTest, RefusesACloudThatIsNotPlanar) {
  const std::filesystem::path path = directory_.path() / "scan.pcd";
  test::expectComplaint(test::complaintOf([&] {
                          read({polar(0, 1, 0.0), polar(1, 1, 0.6)});
                        }),
                        path, {"not a scan of a planar laser", "0.6", "slice"});
  EXPECT_NO_THROW(read({polar(0, 1, 0.0), polar(1, 1, 0.4)}));
}

TEST_F(PlanarScanTest, RefusesOptionsThatMakeNoSense) {
  PlanarScanOptions options;
  options.slice = true;
  for (const auto& [low, high, step] :
       {std::array{1.0, 0.0, 1.0}, {kNan, 1.0, 1.0}, {0.0, 1.0, 0.0}, {0.0, 1.0, kNan}}) {
    options.z_min = low;
    options.z_max = high;
    options.step = step;
    EXPECT_THROW(read({polar(0, 1)}, {}, options), std::invalid_argument) << low << ' ' << high << ' ' << step;
  }
}

TEST_F(PlanarScanTest, SlicesACloudBetweenTwoHeightsOfTheMap) {
  PlanarScanOptions options;
  options.slice = true;
  options.z_min = 1.0;
  options.z_max = 1.5;
  options.step = 90.0;
  // The sensor stands 1 m high: heights 1 to 1.5 m of the map are 0 to 0.5 m of the sensor.
  const LaserScan scan =
      read({polar(10, 3, 0.1), polar(20, 2, 0.4), polar(30, 1, -0.1), polar(100, 4, 0.6), polar(-100, 5, 0.5)},
           posed(0, 0, 1, 0), options);
  expectBeams(scan, {-100, -45, 20, 135}, {5, kNan, 2, kNan});
}

TEST_F(PlanarScanTest, SlicesAsABruteForceSearchDoesWhenTheSensorLeans) {
  Random random(5);
  std::vector<Vector<3>> points;
  for (int i = 0; i < 4000; ++i)
    points.push_back(Vector<3>(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5) * 20.0);
  const Pose pose = posed(3, 4, 5, 40, Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 1, 0).normalized()));
  PlanarScanOptions options;
  options.slice = true;
  options.z_min = 4.0;
  options.z_max = 6.0;
  options.step = 3.0;
  const LaserScan scan = read(points, pose, options);
  ASSERT_EQ(scan.ranges.size(), 120u);
  for (int bin = 0; bin < 120; ++bin) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vector<3>& point : points) {
      const Vector<3> on_map = pose * point;
      if (on_map.z() < 4.0 || on_map.z() > 6.0) continue;
      const Vector<2> way = on_map.head<2>() - scan.pose.translation;
      const double bearing = std::remainder(std::atan2(way.y(), way.x()) - scan.pose.heading, 2.0 * kPi) / kDegree;
      if (std::floor((bearing + 180.0) / 3.0) == bin) nearest = std::min(nearest, way.norm());
    }
    const auto beam = static_cast<std::size_t>(bin);
    ASSERT_EQ(scan.returned(beam), std::isfinite(nearest)) << bin;
    if (scan.returned(beam)) {
      ASSERT_NEAR(scan.ranges[beam], nearest, 1e-9) << bin;
    }
    if (beam > 0) {
      ASSERT_GT(scan.bearings[beam], scan.bearings[beam - 1]);
    }
  }
}

}  // namespace
}  // namespace gaussmap
