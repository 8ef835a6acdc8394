// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "gaussmap/sensor/projection.h"
#include "mesh/shapes.h"
#include "sensor/views.h"
#include "simulation/lidar.h"

namespace gaussmap {
using namespace detail;

namespace {

using Eigen::Vector3d;
using test::camera;
using test::kDegree;
using test::kPi;

using Points = std::vector<Vector3d>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

World room() {
  return World(boxMesh({-12, -9, -1.5}, {14, 8, 6}));
}

/// Rings of `columns` points each, at ranges of 2 to 20 m.
Points ringScan(const std::vector<double>& elevations_deg, int columns) {
  Random random(1);
  Points points;
  for (const double degrees : elevations_deg)
    for (int column = 0; column < columns; ++column) {
      const double azimuth = 2.0 * kPi * (column + 0.3) / columns - kPi, elevation = degrees * kDegree;
      points.push_back((2.0 + 18.0 * random.uniform()) * Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                                  std::cos(elevation) * std::sin(azimuth),
                                                                  std::sin(elevation)));
    }
  return points;
}

std::vector<double> evenly(int rings, double lowest, double highest) {
  std::vector<double> elevations;
  for (int ring = 0; ring < rings; ++ring) elevations.push_back(lowest + (highest - lowest) * ring / (rings - 1));
  return elevations;
}

void shuffle(Points& points) {
  Random random(2);
  for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
}

/// One row for each ring, its borders midway to the next.
void expectRings(const SphericalProjection& found, const std::vector<double>& elevations_deg, double tolerance) {
  ASSERT_EQ(found.row_borders.size(), elevations_deg.size() + 1);
  const std::size_t n = elevations_deg.size();
  for (std::size_t i = 1; i < n; ++i)
    EXPECT_NEAR(found.row_borders[i] / kDegree, 0.5 * (elevations_deg[i - 1] + elevations_deg[i]), tolerance);
  EXPECT_NEAR(found.row_borders[0] / kDegree, 1.5 * elevations_deg[0] - 0.5 * elevations_deg[1], 2.0 * tolerance);
  EXPECT_NEAR(found.row_borders[n] / kDegree, 1.5 * elevations_deg[n - 1] - 0.5 * elevations_deg[n - 2],
              2.0 * tolerance);
}

void expectAllInView(const Projection& projection, const Points& points) {
  for (const Vector3d& point : points) ASSERT_TRUE(pixelOf(projection, point)) << point.transpose();
}

TEST(FindSphericalProjection, FindsTheRingsAndColumnsOfASimulatedLidar) {
  struct Sensor {
    int rings, columns;
    double lowest, highest;
  };
  const World world = room();
  for (const Sensor& sensor : {Sensor{16, 1800, -15, 15}, Sensor{32, 720, -25, 15}, Sensor{64, 2048, -24.8, 2},
                               Sensor{128, 512, -45, 45}, Sensor{5, 100, -20, 20}, Sensor{2, 360, -1, 1}}) {
    LidarOptions options;
    options.rings = sensor.rings;
    options.columns = sensor.columns;
    options.lowest_deg = sensor.lowest;
    options.highest_deg = sensor.highest;
    const SimulatedScan scan = simulateScan(world, {}, options);
    const auto found = findSphericalProjection(scan.points);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->columns, sensor.columns / 2);
    const std::vector<double> rings = evenly(sensor.rings, sensor.lowest, sensor.highest);
    expectRings(*found, rings, (rings[1] - rings[0]) / 10.0);
    expectAllInView(*found, scan.points);
  }
}

TEST(FindSphericalProjection, FindsRingsThatAreNotEvenlySpaced) {
  std::vector<double> dense_above = evenly(32, -24.33, -8.83);
  for (const double degrees : evenly(32, -8.33, 2.0)) dense_above.push_back(degrees);
  const std::vector<double> dense_in_the_middle = {-25, -15.6, -11.3, -8.8, -7.2, -6.1, -5.3, -4.7, -4,   -3.7, -3.3,
                                                   -3,  -2.7,  -2.3,  -2,   -1.7, -1.3, -1,   -0.7, -0.3, 0,    0.3,
                                                   0.7, 1,     1.3,   1.7,  2.3,  3.3,  4.7,  7,    10.3, 15};
  for (const std::vector<double>& rings : {dense_above, dense_in_the_middle}) {
    const Points points = ringScan(rings, 900);
    const auto found = findSphericalProjection(points);
    ASSERT_TRUE(found);
    expectRings(*found, rings, 0.05);
    EXPECT_EQ(found->columns, 450);
    expectAllInView(*found, points);
  }
}

TEST(FindSphericalProjection, ToleratesGapsInAScan) {
  const std::vector<double> rings = evenly(16, -15, 15);
  Points points = ringScan(rings, 720);
  Random random(3);
  points.erase(std::remove_if(points.begin(), points.end(),
                              [&](const Vector3d& p) {
                                return (p.x() < 0.0 && p.y() > -2.0) || (p.z() > 0.5 && p.x() > 3.0) ||
                                       random.below(10) < 3;
                              }),
               points.end());
  const auto found = findSphericalProjection(points);
  ASSERT_TRUE(found);
  expectRings(*found, rings, 0.2);
  EXPECT_EQ(found->columns, 360);
}

TEST(FindSphericalProjection, FindsInLargeScansTheRingsThatFewBeamsOfCameBack) {  // trees before the sky
  const std::vector<double> rings = evenly(64, -24, 12);
  for (const double direction : {-170.0, -100.0, -31.0, 2.0, 77.0, 141.0}) {
    Points points = ringScan(rings, 2048);
    points.erase(std::remove_if(points.begin(), points.end(),
                                [&](const Vector3d& p) {
                                  const double azimuth = std::atan2(p.y(), p.x()) / kDegree;
                                  return p.z() > 0.0 && std::abs(azimuth - direction) > 3.0;
                                }),
                 points.end());
    const auto found = findSphericalProjection(points);
    ASSERT_TRUE(found);
    expectRings(*found, rings, 0.1);
    EXPECT_EQ(found->columns, 1024);
  }
}

TEST(FindSphericalProjection, DoesNotDependOnTheOrderOfThePoints) {
  for (const int columns : {300, 3000}) {
    Points points = ringScan(evenly(16, -15, 15), columns);
    const auto found = findSphericalProjection(points);
    shuffle(points);
    const auto again = findSphericalProjection(points);
    EXPECT_EQ(again->row_borders, found->row_borders);
    EXPECT_EQ(again->columns, found->columns);
  }
}

TEST(FindSphericalProjection, LeavesOutWhatIsNoReturn) {
  Points points = ringScan(evenly(16, -15, 15), 300);
  const auto found = findSphericalProjection(points);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3000; ++i)
    points.insert(points.begin() + static_cast<std::ptrdiff_t>(7 * i % points.size()), i % 3 == 0 ? Vector3d(kNaN, 0, 1)
                                                                                       : i % 3 == 1
                                                                                           ? Vector3d(0, 0, 0)
                                                                                           : Vector3d(1, -infinity, 1));
  const auto again = findSphericalProjection(points);
  EXPECT_EQ(again->row_borders, found->row_borders);
  EXPECT_EQ(again->columns, found->columns);
}

TEST(FindSphericalProjection, GivesAPlanarLaserOneRow) {
  const SimulatedScan scan = simulateScan(room(), {}, PlanarLaserOptions{});  // a beam every half degree
  const auto found = findSphericalProjection(scan.points);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->row_borders.size(), 2u);
  EXPECT_EQ(found->columns, 360);
  expectAllInView(*found, scan.points);
}

TEST(FindSphericalProjection, SeesEveryPointWithoutRingsToo) {
  Random random(5);
  Points points;
  for (int i = 0; i < 20000; ++i) points.push_back((1.0 + random.uniform()) * test::randomDirection(random));
  const auto found = findSphericalProjection(points);
  ASSERT_TRUE(found);
  EXPECT_GT(found->row_borders.size(), 5u);
  expectAllInView(*found, points);
}

TEST(FindSphericalProjection, NeedsThreePoints) {
  EXPECT_FALSE(findSphericalProjection({}));
  EXPECT_FALSE(findSphericalProjection({{1, 0, 0}}));
  EXPECT_FALSE(findSphericalProjection({{1, 0, 0}, {0, 1, 0}}));
  EXPECT_FALSE(findSphericalProjection({{1, 0, 0}, {0, 1, 0}, {kNaN, 1, 1}, {0, 0, 0}}));
  Random random(6);
  for (int trial = 0; trial < 200; ++trial) {
    const Points three = {test::randomDirection(random), test::randomDirection(random), test::randomDirection(random)};
    const auto found = findSphericalProjection(three);
    ASSERT_TRUE(found);
    checkProjection(*found);
    expectAllInView(*found, three);
  }
}

TEST(FindSphericalProjection, TakesPointsThatAreAllTheSame) {
  for (const Vector3d& point : {Vector3d(3, 4, 1), Vector3d(0, 0, 2), Vector3d(-1, 0, 0), Vector3d(1e-300, 0, 1e-300),
                                Vector3d(1e200, 1e200, -1e200)}) {
    const Points same(100, point);
    const auto found = findSphericalProjection(same);
    ASSERT_TRUE(found);
    checkProjection(*found);
    EXPECT_EQ(found->row_borders.size(), 2u);
    expectAllInView(*found, same);
  }
}

/// What the camera sees: a depth of 1 to 4 m in every pixel.
Points depthImage(const PlanarProjection& projection) {
  Random random(7);
  Points points;
  for (int row = 0; row < projection.rows; ++row)
    for (int column = 0; column < projection.columns; ++column)
      points.push_back((1.0 + 3.0 * random.uniform()) *
                       Vector3d((column - projection.cx) / projection.fx, (row - projection.cy) / projection.fy, 1));
  return points;
}

TEST(FindPlanarProjection, RecoversTheCamera) {
  Points points = depthImage(camera());
  Random random(8);
  for (Vector3d& point : points)
    if (random.below(3) == 0) point = Vector3d::Constant(kNaN);
  const auto found = findPlanarProjection(points, 64);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->fx, 60.0, 1e-9);
  EXPECT_NEAR(found->fy, 55.0, 1e-9);
  EXPECT_NEAR(found->cx, 31.5, 1e-9);
  EXPECT_NEAR(found->cy, 23.2, 1e-9);
  EXPECT_EQ(found->columns, 64);
  EXPECT_EQ(found->rows, 48);
}

TEST(FindPlanarProjection, RefusesWhatNoCameraSees) {
  const Points image = depthImage(camera());
  EXPECT_FALSE(findPlanarProjection(image, 63));  // rows are not full
  EXPECT_FALSE(findPlanarProjection(image, 32));
  EXPECT_FALSE(findPlanarProjection(image, 1));
  EXPECT_FALSE(findPlanarProjection(image, 0));
  EXPECT_FALSE(findPlanarProjection(image, -4));
  EXPECT_FALSE(findPlanarProjection({}, 64));
  EXPECT_FALSE(findPlanarProjection({image.begin(), image.begin() + 64}, 64));  // one row
  Points mirrored = image, nothing(image.size(), Vector3d::Constant(kNaN)), behind = image, line = nothing;
  for (Vector3d& point : mirrored) point.x() *= -1.0;
  for (Vector3d& point : behind) point *= -1.0;
  std::copy(image.begin(), image.begin() + 64, line.begin());  // one row of many has depth
  EXPECT_FALSE(findPlanarProjection(mirrored, 64));
  EXPECT_FALSE(findPlanarProjection(nothing, 64));
  EXPECT_FALSE(findPlanarProjection(behind, 64));
  EXPECT_FALSE(findPlanarProjection(line, 64));
}

TEST(FindPlanarProjection, RefusesAnOrganisedLidar) {
  const Points scan = ringScan(evenly(64, 12, -24), 512);  // row by row from the uppermost ring
  EXPECT_FALSE(findPlanarProjection(scan, 512));
  Points forward = scan;  // as if z were its forward axis
  for (Vector3d& point : forward) point = {point.y(), -point.z(), point.x()};
  EXPECT_FALSE(findPlanarProjection(forward, 512));
}

TEST(FindProjection, TakesTheCameraOfOrganisedCloudsElseTheLidar) {
  const Points image = depthImage(camera()), scan = ringScan(evenly(16, 15, -15), 512);
  EXPECT_TRUE(std::holds_alternative<PlanarProjection>(*findProjection(image, 64)));
  EXPECT_TRUE(std::holds_alternative<SphericalProjection>(*findProjection(image)));
  EXPECT_EQ(rowsOf(*findProjection(scan, 512)), 16);
  EXPECT_EQ(columnsOf(*findProjection(scan, 512)), 256);
  EXPECT_EQ(rowsOf(*findProjection(scan)), 16);
  EXPECT_FALSE(findProjection({}));
  EXPECT_FALSE(findProjection({{1, 1, 1}, {1, 2, 3}}, 1));
}

}  // namespace
}  // namespace gaussmap
