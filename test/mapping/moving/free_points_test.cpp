// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/moving/moving_points.h"
#include "map/inherit_occupancy.h"

namespace gaussmap {
using namespace detail;

namespace {

/// A wall of 20 m x 20 m at x = 10, with a cell every 0.1 m. The sensor is at the origin.
GaussianMapOctree wallMap() {
  std::vector<Vector<3>> points;
  for (int y = -100; y < 100; ++y)
    for (int z = -100; z < 100; ++z) points.emplace_back(10.05, 0.1 * y + 0.05, 0.1 * z + 0.05);
  return build<3>(points, {0.1, 10, 3, 0.0});
}

std::vector<bool> freeIn(const GaussianMapOctree& map, const std::vector<Vector<3>>& points,
                         UnknownSpace unknown = UnknownSpace::Automatic) {
  FreePointOptions options;
  options.unknown = unknown;
  return freePoints(map, points, Vector<3>::Zero(), options);
}

TEST(FreePoints, AreInFrontOfASurfaceOfTheMap) {
  const GaussianMapOctree map = wallMap();
  EXPECT_EQ(freeIn(map, {{5, 0, 0}}), (std::vector<bool>{true}));
  EXPECT_EQ(freeIn(map, {{5, 3, -2}}), (std::vector<bool>{true}));
  EXPECT_EQ(freeIn(map, {{10.05, 0.05, 0.05}}), (std::vector<bool>{false}));  // in a cell
  EXPECT_EQ(freeIn(map, {{9.85, 0, 0}}), (std::vector<bool>{false}));         // beside the wall, tolerance 0.3 m
  EXPECT_EQ(freeIn(map, {{12, 0, 0}}), (std::vector<bool>{false}));           // hidden by the wall
  EXPECT_EQ(freeIn(map, {{-5, 0, 0}}), (std::vector<bool>{false}));           // no surface in this direction
  EXPECT_EQ(freeIn(map, {{5, 0, 5.5}}), (std::vector<bool>{false}));          // above the wall
}

TEST(FreePoints, DependOnThePlaceOfTheSensor) {
  const GaussianMapOctree map = wallMap();
  EXPECT_EQ(freePoints(map, {{12, 0, 0}}, {20, 0, 0}), (std::vector<bool>{true}));
  EXPECT_EQ(freePoints(map, {{5, 0, 0}}, {20, 0, 0}), (std::vector<bool>{false}));
}

TEST(FreePoints, AreThoseOfTheWholeObject) {
  std::vector<Vector<3>> object;  // from x = 5 to the wall: the end at the wall is not clearly in front of it
  for (int i = 0; i <= 33; ++i) object.emplace_back(5.0 + 0.15 * i, 0.0, 0.0);
  std::vector<bool> free = freeIn(wallMap(), object);
  for (std::size_t i = 0; i < object.size(); ++i) EXPECT_TRUE(free[i]) << object[i].x();
  object.emplace_back(9.85, 5.0, 0.0);  // as near to the wall, but connected to nothing
  free = freeIn(wallMap(), object);
  EXPECT_FALSE(free.back());
}

TEST(FreePoints, GrowOverAtMostFourCubes) {
  // A rod along the wall: only its first point is clearly in front of the wall. The points are in cubes side by side.
  std::vector<Vector<3>> rod{{9.5, 0.1, 0.1}, {9.7, 0.1, 0.1}};
  for (int i = 1; i < 10; ++i) rod.emplace_back(9.9, 0.1 + 0.2 * i, 0.1);
  const std::vector<bool> free = freeIn(wallMap(), rod);
  for (std::size_t i = 0; i < rod.size(); ++i) EXPECT_EQ(free[i], i <= 4) << i;
}

TEST(FreePoints, AreAllOrNoneOfTheUnknownOnesIfAsked) {
  const GaussianMapOctree map = wallMap();
  const std::vector<Vector<3>> points{{5, 0, 0}, {12, 0, 0}, {1e30, 0, 0}, {10.05, 0.05, 0.05}};
  EXPECT_EQ(freeIn(map, points, UnknownSpace::Keep), (std::vector<bool>{false, false, false, false}));
  EXPECT_EQ(freeIn(map, points, UnknownSpace::Remove), (std::vector<bool>{true, true, true, false}));
}

TEST(FreePoints, AreInCellsOfLowLogOdds) {
  const GaussianMapOctree wall = wallMap();
  std::vector<float> log_odds;
  for (std::size_t i = 0; i < wall.gaussianCount(0); ++i)
    log_odds.push_back(wall.gaussian(i, 0).mean.y() < 0.0 ? -1.0f : 1.0f);
  const GaussianMapOctree map = withOccupancy<3>(wall, log_odds);
  const std::vector<Vector<3>> points{{10.05, -2.05, 0.05}, {10.05, 2.05, 0.05}, {5, -2, 0}, {5, 2, 0}};
  // A free cluster is no surface: nothing is behind the third point.
  EXPECT_EQ(freeIn(map, points), (std::vector<bool>{true, false, false, true}));
}

TEST(FreePoints, DoNotDependOnTheNumberOfThreads) {
  const GaussianMapOctree map = wallMap();
  Random random(3);
  std::vector<Vector<3>> points;
  for (int i = 0; i < 20000; ++i)
    points.emplace_back(12.0 * random.uniform(), 16.0 * random.uniform() - 8.0, 16.0 * random.uniform() - 8.0);
  FreePointOptions one;
  one.threads = 1;
  EXPECT_EQ(freePoints(map, points, Vector<3>::Zero(), one), freePoints(map, points, Vector<3>::Zero()));
}

TEST(FreePoints, TakeAnyInput) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(freeIn(wallMap(), {{nan, 0, 0}, {infinite, 0, 0}, {0, 0, 0}}), (std::vector<bool>{false, false, false}));
  EXPECT_EQ(freeIn(wallMap(), {{nan, 0, 0}}, UnknownSpace::Remove), (std::vector<bool>{false}));
  EXPECT_TRUE(freeIn(wallMap(), {}).empty());
  EXPECT_EQ(freeIn(GaussianMapOctree(), {{5, 0, 0}}), (std::vector<bool>{false}));
  EXPECT_EQ(freeIn(GaussianMapOctree(), {{5, 0, 0}}, UnknownSpace::Remove), (std::vector<bool>{true}));
  EXPECT_THROW(freePoints(wallMap(), {{5, 0, 0}}, {nan, 0, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
