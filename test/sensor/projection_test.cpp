// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/sensor/projection.h"

#include "gaussmap/core/scans.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "sensor/views.h"

namespace gaussmap {
namespace {

using Eigen::Vector3d;
using test::camera;
using test::kDegree;
using test::lidar;
using test::randomDirection;
using test::randomPointOfBall;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vector3d towards(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree, e = elevation_deg * kDegree;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

TEST(Projections, SeeEveryPixelThroughItsMiddle) {
  for (const Projection& projection : {Projection(lidar(16, -25, 15, 90)), Projection(lidar(1, -1, 1, 7)),
                                       Projection(lidar(9, -90, 90, 1)), Projection(camera())}) {
    for (int row = 0; row < rowsOf(projection); ++row)
      for (int column = 0; column < columnsOf(projection); ++column) {
        const Vector3d direction = directionOf(projection, {row, column});
        EXPECT_NEAR(direction.norm(), 1.0, 1e-15);
        for (const double range : {1e-6, 1.0, 1e6}) {
          const auto pixel = pixelOf(projection, range * direction);
          ASSERT_TRUE(pixel.has_value());
          EXPECT_EQ(pixel->row, row);
          EXPECT_EQ(pixel->column, column);
        }
      }
  }
}

TEST(Projections, WrapOnlyIfTheyAreSpherical) {
  EXPECT_TRUE(wraps(lidar(2, -5, 5, 8)));
  EXPECT_FALSE(wraps(camera()));
}

TEST(Projections, DoNotSeeWhatIsNoReturn) {
  const Vector3d none[] = {{0, 0, 0},    {-0.0, 0, 0},      {kNaN, 1, 1},       {1, kNaN, 1},
                           {1, 1, kNaN}, {kInfinity, 1, 1}, {1, -kInfinity, 1}, {1, 1, kInfinity}};
  for (const Vector3d& point : none) {
    EXPECT_FALSE(isReturn(point));
    EXPECT_FALSE(pixelOf(lidar(4, -90, 90, 8), point));
    EXPECT_FALSE(pixelOf(camera(), point));
  }
  EXPECT_TRUE(isReturn({0, 0, 1e-300}));
}

TEST(SphericalProjections, BeginBehindTheSensorAndTurnCounterClockwise) {
  const Projection projection = lidar(1, -10, 10, 4);
  EXPECT_EQ(pixelOf(projection, {-1, -1, 0})->column, 0);
  EXPECT_EQ(pixelOf(projection, {1, -1, 0})->column, 1);
  EXPECT_EQ(pixelOf(projection, {1, 1, 0})->column, 2);
  EXPECT_EQ(pixelOf(projection, {-1, 1, 0})->column, 3);
}

TEST(SphericalProjections, AreCutBehindTheSensor) {
  const Projection projection = lidar(1, -10, 10, 3600);
  EXPECT_EQ(pixelOf(projection, {-1, 1e-12, 0})->column, 3599);
  EXPECT_EQ(pixelOf(projection, {-1, 0.0, 0})->column, 3599);
  EXPECT_EQ(pixelOf(projection, {-1, -0.0, 0})->column, 0);
  EXPECT_EQ(pixelOf(projection, {-1, -1e-12, 0})->column, 0);
}

TEST(SphericalProjections, HaveRowsBetweenTheirBorders) {
  const Projection projection = SphericalProjection{{-0.1, 0.0, 0.3}, 4};
  EXPECT_EQ(rowsOf(projection), 2);
  EXPECT_EQ(pixelOf(projection, {1, 1, -0.05})->row, 0);
  EXPECT_EQ(pixelOf(projection, {1, 1, 0})->row, 1);  // a border belongs to the row above it
  EXPECT_EQ(pixelOf(projection, {1, 1, 0.4})->row, 1);
  EXPECT_FALSE(pixelOf(projection, {1, 1, -0.15}));
  EXPECT_FALSE(pixelOf(projection, {1, 1, 0.45}));
}

TEST(SphericalProjections, MayLookStraightUp) {
  EXPECT_EQ(pixelOf(lidar(3, -90, 91, 8), {0, 0, 5})->row, 2);
  EXPECT_FALSE(pixelOf(lidar(3, -90, 89, 8), {0, 0, 5}));
}

TEST(PlanarProjections, CountFromTheMiddleOfTheFirstPixel) {
  const Projection projection = PlanarProjection{100, 50, 2, 1, 6, 4};
  const auto at = [&](double column, double row) {
    return pixelOf(projection, 3.0 * Vector3d((column - 2) / 100, (row - 1) / 50, 1));
  };
  EXPECT_EQ(at(0, 0)->column, 0);
  EXPECT_EQ(at(0, 0)->row, 0);
  EXPECT_EQ(at(4.4, 2.6)->column, 4);
  EXPECT_EQ(at(4.4, 2.6)->row, 3);
  EXPECT_TRUE(at(-0.49, -0.49));
  EXPECT_FALSE(at(-0.51, 0));
  EXPECT_FALSE(at(0, -0.51));
  EXPECT_TRUE(at(5.49, 3.49));
  EXPECT_FALSE(at(5.51, 0));
  EXPECT_FALSE(at(0, 3.51));
}

TEST(PlanarProjections, DoNotSeeWhatIsBehindThem) {
  EXPECT_TRUE(pixelOf(camera(), {0, 0, 1}));
  EXPECT_FALSE(pixelOf(camera(), {0, 0, -1}));
  EXPECT_FALSE(pixelOf(camera(), {0.1, 0, 0}));
  EXPECT_FALSE(pixelOf(camera(), {1e300, 0, 1e-300}));  // its column is no number
}

bool contains(const Projection& projection, const PixelBox& box, Pixel pixel) {
  if (pixel.row < box.first_row || pixel.row > box.last_row) return false;
  const int turn = wraps(projection) ? columnsOf(projection) : 0;
  for (const int column : {pixel.column, pixel.column - turn, pixel.column + turn})
    if (column >= box.first_column && column <= box.last_column) return true;
  return false;
}

/// Where balls are hard.
std::vector<Vector3d> hardCentres(Random& random) {
  const auto little = [&] { return 0.3 * random.normal(); };
  return {3.0 * randomDirection(random),
          {little(), little(), 2.0},
          {little(), little(), -2.0},
          {-2.0, little(), little()},
          {-3.0, 0.0, little()},
          {little(), little(), little()},
          {2.0 * random.normal(), little(), 0.05},
          {little(), little(), 1.0},
          {0.0, 0.0, 1.5},
          {little(), -2.0, 0.01 * random.normal()}};
}

TEST(PixelsOfABall, HoldThePixelOfEveryPointOfIt) {
  Random random(1);
  int seen = 0, tight = 0;
  for (const Projection& projection :
       {Projection(lidar(16, -25, 15, 90)), Projection(lidar(40, -90, 90, 360)), Projection(lidar(1, -2, 2, 500)),
        Projection(lidar(6, 20, 85, 3)), Projection(SphericalProjection{{-1.2, -0.3, -0.29, 0.0, 1.5}, 2}),
        Projection(lidar(8, -90, 90, 1)), Projection(camera())})
    for (int trial = 0; trial < 300; ++trial)
      for (const Vector3d& centre : hardCentres(random)) {
        const double radius = trial % 10 == 0 ? 0.0 : std::exp(1.5 * random.normal() - 1.0);
        const PixelBox box = pixelsOf(projection, centre, radius);
        ASSERT_GE(box.first_row, 0);
        ASSERT_LT(box.last_row, rowsOf(projection));
        tight += (box.last_column - box.first_column) * 4 < columnsOf(projection);
        for (int i = 0; i < 30; ++i) {
          const auto pixel = pixelOf(projection, randomPointOfBall(random, centre, radius));
          if (!pixel) continue;
          ++seen;
          ASSERT_TRUE(contains(projection, box, *pixel))
              << "centre " << centre.transpose() << " radius " << radius << " rows " << rowsOf(projection)
              << " columns " << columnsOf(projection);
        }
      }
  EXPECT_GT(seen, 100000);
  EXPECT_GT(tight, 2000);  // a box of all pixels would pass too
}

TEST(PixelsOfABall, HoldTheUppermostPointIfItsRowBeginsThere) {  // near the sensor an arc sine is rounded worst
  Random random(2);
  int held = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const double range = 1.0 + std::exp(-30.0 * random.uniform()), width = std::asin(1.0 / range);
    const double azimuth = 300.0 * random.uniform(), elevation = -90.0 * random.uniform();
    const Vector3d centre = range * towards(azimuth, elevation);
    const Vector3d uppermost = std::sqrt(range * range - 1.0) * towards(azimuth, elevation + width / kDegree);
    if ((uppermost - centre).norm() > 1.0) continue;  // rounded out of the ball
    const double border = std::atan2(uppermost.z(), std::hypot(uppermost.x(), uppermost.y()));
    const Projection projection = SphericalProjection{{-2.0, border, 2.0}, 8};
    ASSERT_EQ(pixelOf(projection, uppermost)->row, 1);
    ASSERT_EQ(pixelsOf(projection, centre, 1.0).last_row, 1);
    ++held;
  }
  EXPECT_GT(held, 2000);
}

TEST(PixelsOfABall, AreThoseOfItsAngularRadius) {  // seen 9.5 degrees wide to either side
  const double radius = 10.0 * std::sin(9.5 * kDegree);
  const Projection projection = lidar(180, -90, 90, 360);
  const PixelBox level = pixelsOf(projection, {10, 0, 0}, radius);
  EXPECT_EQ(level.first_column, 170);
  EXPECT_EQ(level.last_column, 189);
  EXPECT_EQ(level.first_row, 80);
  EXPECT_EQ(level.last_row, 99);
  const PixelBox behind = pixelsOf(projection, {-10, -0.0, 0}, radius);
  EXPECT_EQ(behind.first_column, -10);  // past the cut
  EXPECT_EQ(behind.last_column, 9);
  const PixelBox high = pixelsOf(projection, 10.0 * towards(0, 60), radius);
  EXPECT_EQ(high.first_row, 140);
  EXPECT_EQ(high.last_row, 159);
  EXPECT_EQ(high.last_column, 180 + 19);  // asin(sin 9.5 / cos 60) = 19.3
  const PixelBox zenith = pixelsOf(projection, 10.0 * towards(0, 81), radius);
  EXPECT_EQ(zenith.first_row, 161);
  EXPECT_EQ(zenith.last_row, 179);
  EXPECT_EQ(zenith.first_column, 0);
  EXPECT_EQ(zenith.last_column, 359);

  const PixelBox planar = pixelsOf(PlanarProjection{100, 100, 50, 50, 101, 101}, {0, 0, 10}, radius);
  EXPECT_EQ(planar.first_column, 33);  // 50 - 100 tan 9.5 = 33.3
  EXPECT_EQ(planar.last_column, 67);
  EXPECT_EQ(planar.first_row, 33);
  EXPECT_EQ(planar.last_row, 67);
}

TEST(PixelsOfABall, AreNoneOutOfView) {
  EXPECT_TRUE(pixelsOf(lidar(8, -10, 10, 90), {1, 0, 1}, 0.1).empty());
  EXPECT_TRUE(pixelsOf(lidar(8, -10, 10, 90), {1, 0, -1}, 0.1).empty());
  EXPECT_FALSE(pixelsOf(lidar(8, -10, 10, 90), {1, 0, 1}, 0.9).empty());
  EXPECT_TRUE(pixelsOf(camera(), {0, 0, -1}, 0.9).empty());
  EXPECT_FALSE(pixelsOf(camera(), {0, 0, -1}, 1.1).empty());  // reaches before the camera
  EXPECT_TRUE(pixelsOf(camera(), {5, 0, 3}, 0.5).empty());
  EXPECT_TRUE(pixelsOf(camera(), {-5, 0, 3}, 0.5).empty());
  EXPECT_TRUE(pixelsOf(camera(), {0, 5, 3}, 0.5).empty());
  EXPECT_TRUE(pixelsOf(camera(), {0, -5, 3}, 0.5).empty());
}

TEST(PixelsOfABall, AreAllAroundTheSensor) {
  const PixelBox box = pixelsOf(lidar(8, -10, 10, 90), {0.1, 0, 0}, 0.2);
  EXPECT_EQ(box.first_row, 0);
  EXPECT_EQ(box.last_row, 7);
  EXPECT_EQ(box.last_column - box.first_column, 89);
}

std::string refusalOf(const Projection& projection) {
  try {
    checkProjection(projection);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CheckProjection, NamesWhatIsNotUsable) {
  EXPECT_EQ(refusalOf(lidar(8, -10, 10, 90)), "");
  EXPECT_EQ(refusalOf(camera()), "");
  using Spherical = SphericalProjection;
  EXPECT_EQ(refusalOf(Spherical{{}, 5}), "a spherical projection needs at least 2 row borders");
  EXPECT_EQ(refusalOf(Spherical{{0.5}, 5}), "a spherical projection needs at least 2 row borders");
  EXPECT_EQ(refusalOf(Spherical{{0.0, 0.5, 0.5}, 5}),
            "row border 2 = 0.5: must be finite and above the border before it");
  EXPECT_EQ(refusalOf(Spherical{{0.0, kNaN}, 5}), "row border 1 = nan: must be finite and above the border before it");
  EXPECT_EQ(refusalOf(Spherical{{-kInfinity, 0.0}, 5}),
            "row border 0 = -inf: must be finite and above the border before it");
  EXPECT_EQ(refusalOf(Spherical{{0.0, 1.0}, 0}), "columns = 0: must be at least 1");
  EXPECT_EQ(refusalOf(Spherical{{0.0, 0.5, 1.0}, 2147483647}),
            "an image of 2 x 2147483647 pixels is too large: at most 2^28");
  const auto changed = [](auto change) {
    PlanarProjection projection = camera();
    change(projection);
    return refusalOf(projection);
  };
  EXPECT_EQ(changed([](auto& p) { p.fx = 0.0; }), "fx = 0: must be positive and finite");
  EXPECT_EQ(changed([](auto& p) { p.fx = kNaN; }), "fx = nan: must be positive and finite");
  EXPECT_EQ(changed([](auto& p) { p.fy = -2.0; }), "fy = -2: must be positive and finite");
  EXPECT_EQ(changed([](auto& p) { p.fy = kInfinity; }), "fy = inf: must be positive and finite");
  EXPECT_EQ(changed([](auto& p) { p.cx = kNaN; }), "cx = nan: must be finite");
  EXPECT_EQ(changed([](auto& p) { p.cy = kInfinity; }), "cy = inf: must be finite");
  EXPECT_EQ(changed([](auto& p) { p.rows = 0; }), "rows = 0: must be at least 1");
  EXPECT_EQ(changed([](auto& p) { p.columns = -3; }), "columns = -3: must be at least 1");
}

}  // namespace
}  // namespace gaussmap
