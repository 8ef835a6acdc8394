// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/sensor/range_image.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "sensor/views.h"

namespace gaussmap {
namespace {

using Eigen::Vector3d;
using test::camera;
using test::lidar;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(RangeImages, KeepTheSmallestAndTheLargestRangeOfEachPixel) {
  const Projection projection = lidar(2, -10, 10, 4);  // columns of a quarter turn, rows below and above the horizon
  const RangeImage image(projection, {{3, 4, 0.1}, {4, 3, 0.2}, {0.6, 0.8, 0.01}, {2, 2, -0.1}, {-5, -12, 0.5}});
  EXPECT_EQ(image.rows(), 2);
  EXPECT_EQ(image.columns(), 4);
  EXPECT_FLOAT_EQ(image.at(1, 2).nearest, float(Vector3d(0.6, 0.8, 0.01).norm()));
  EXPECT_FLOAT_EQ(image.at(1, 2).farthest, float(Vector3d(4, 3, 0.2).norm()));
  EXPECT_FLOAT_EQ(image.at(0, 2).nearest, float(Vector3d(2, 2, -0.1).norm()));
  EXPECT_EQ(image.at(0, 2).nearest, image.at(0, 2).farthest);
  EXPECT_FLOAT_EQ(image.at(1, 0).nearest, float(Vector3d(-5, -12, 0.5).norm()));
  EXPECT_FLOAT_EQ(image.farthest(), float(Vector3d(-5, -12, 0.5).norm()));
  for (const Pixel pixel : {Pixel{0, 0}, Pixel{0, 1}, Pixel{0, 3}, Pixel{1, 1}, Pixel{1, 3}})
    EXPECT_TRUE(image.at(pixel.row, pixel.column).empty());
}

TEST(RangeImages, LeaveOutWhatTheyDoNotSee) {
  RangeImage image(lidar(2, -10, 10, 4));
  for (const Vector3d& point :
       {Vector3d(0, 0, 0), Vector3d(kNaN, 1, 0), Vector3d(1, kInfinity, 0), Vector3d(1, 1, 3), Vector3d(1, 1, -3)})
    image.add(point);
  image.add({1e39, 1, 0});  // finite, but no float: would free all before it
  image.add({1e200, 1, 0});
  EXPECT_EQ(image.farthest(), 0.0f);
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column) EXPECT_TRUE(image.at(row, column).empty());
}

TEST(RangeImages, AreFreeWithoutReturnIfAsked) {
  RangeImage image(lidar(1, -10, 10, 4), {{3, 4, 0}});
  image.noReturnIsFree(20.0);
  EXPECT_EQ(image.at(0, 2).nearest, 5.0f);  // a return says more
  EXPECT_EQ(image.at(0, 2).farthest, 5.0f);
  for (const int column : {0, 1, 3}) EXPECT_EQ(image.at(0, column).nearest, 20.0f);
  EXPECT_EQ(image.farthest(), 20.0f);
  EXPECT_TRUE(image.around(1, 0).empty());  // outside there is no pixel
  for (const double range : {0.0, -1.0, kNaN, kInfinity, 1e39, 1e-60})
    EXPECT_THROW(image.noReturnIsFree(range), std::invalid_argument) << range;
}

TEST(RangeImages, GoRoundIfTheSensorTurns) {
  const RangeImage image(lidar(1, -10, 10, 4), {{-3, -4, 0}, {-6, 8, 0}});  // in the first column and the last
  EXPECT_EQ(image.around(0, -1).nearest, 10.0f);
  EXPECT_EQ(image.around(0, 4).nearest, 5.0f);
  EXPECT_EQ(image.around(0, -9).nearest, 10.0f);
  EXPECT_EQ(image.around(0, 40).nearest, 5.0f);
  EXPECT_TRUE(image.around(0, 5).empty());
  EXPECT_TRUE(image.around(-1, 0).empty());
  EXPECT_TRUE(image.around(1, 0).empty());
}

TEST(RangeImages, EndAtTheirBordersIfTheSensorIsACamera) {
  const RangeImage image = test::imageOf(camera(), [](const Vector3d&) { return 2.0; });
  EXPECT_EQ(image.around(0, 0).nearest, 2.0f);
  EXPECT_EQ(image.around(47, 63).nearest, 2.0f);
  for (const Pixel pixel : {Pixel{-1, 5}, Pixel{48, 5}, Pixel{5, -1}, Pixel{5, 64}})
    EXPECT_TRUE(image.around(pixel.row, pixel.column).empty());
}

TEST(RangeImages, PutTheNearestRangeIntoTheMiddleOfThePixel) {
  const Projection projection = lidar(2, -10, 10, 4);
  RangeImage image(projection, {{3, 4, 0.1}, {30, 40, 0.1}, {-2, 3, -0.1}, {-2, -3, 0.2}});
  EXPECT_LT((image.nearestPoint(1, 2) - Vector3d(3, 4, 0.1).norm() * directionOf(projection, {1, 2})).norm(), 1e-6);
  // Round the cut, in the first row and in the last.
  EXPECT_LT((image.nearestPoint(0, -1) - image.nearestPoint(0, 3)).norm(), 1e-6);
  EXPECT_LT((image.nearestPoint(1, 4) - image.nearestPoint(1, 0)).norm(), 1e-6);
}

TEST(RangeImages, RefuseProjectionsThatAreNotUsable) {
  EXPECT_THROW(RangeImage(SphericalProjection{}), std::invalid_argument);
  EXPECT_THROW(RangeImage(PlanarProjection{}), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
