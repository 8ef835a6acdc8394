// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/culling.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/mapping/build.h"
#include "mapping/moving/map_cells.h"
#include "sensor/views.h"

namespace gaussmap {
using namespace detail;

namespace {

using Eigen::Vector3d;
using test::camera;
using test::imageOf;
using test::lidar;
using test::randomDirection;
using test::randomPointOfBall;

/// Patches of a few pixels at the same range, some without returns.
RangeImage randomImage(const Projection& projection, Random& random) {
  RangeImage image = imageOf(projection, [&](const Vector3d&) { return 2.0 + 2.0 * random.uniform(); });
  RangeImage patches(projection);
  const int rows = image.rows(), columns = image.columns();
  const int height = 1 + int(random.below(8)), width = 1 + int(random.below(16));
  std::vector<double> ranges(std::size_t((rows / height + 1) * (columns / width + 1)));
  for (double& range : ranges) range = random.below(4) == 0 ? 0.0 : 1.0 + 12.0 * random.uniform() * random.uniform();
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double range = ranges[std::size_t(row / height * (columns / width + 1) + column / width)];
      if (range > 0.0 && random.below(10) > 0) patches.add(range * directionOf(projection, {row, column}));
    }
  return patches;
}

TEST(Cullings, NeverHideAPointThatBeamsHitOrPassedThrough) {
  const Projection projections[] = {lidar(16, -25, 15, 90),
                                    lidar(32, -90, 91, 180),  // both poles
                                    lidar(1, -4, 4, 200),
                                    lidar(7, 10, 91, 5),
                                    lidar(3, -60, 60, 2),
                                    lidar(12, -40, 40, 1),
                                    camera(),
                                    PlanarProjection{6, 6, 4, 4, 9, 9},  // wide: sees almost sideways
                                    PlanarProjection{200, 200, 3, 2, 8, 5}};
  Random random(1);
  int passed = 0, at_surface = 0, hidden = 0, hidden_in_view = 0, unseen_in_view = 0;
  for (const Projection& projection : projections)
    for (int scene = 0; scene < 40; ++scene) {
      const RangeImage image = randomImage(projection, random);
      const Culling culling(image);
      for (int ball = 0; ball < 200; ++ball) {
        Vector3d centre = 12.0 * random.uniform() * randomDirection(random);
        if (ball % 4 == 0) centre = {0.3 * random.normal(), 0.3 * random.normal(), 8.0 * random.uniform() - 4.0};
        if (ball % 4 == 1) centre = {-5.0 * random.uniform(), 0.2 * random.normal(), random.normal()};
        const double radius = ball % 7 == 0 ? 0.0 : std::exp(random.normal() - 1.0);
        const bool may = culling.mayPassThrough(centre, radius), may_see = culling.maySee(centre, radius);
        EXPECT_TRUE(may_see || !may);
        hidden += !may;
        hidden_in_view += !may && pixelOf(projection, centre);
        unseen_in_view += !may_see && pixelOf(projection, centre);
        for (int i = 0; i < 20; ++i) {
          const Vector3d point = radius > 0.0 ? randomPointOfBall(random, centre, radius) : centre;
          const Visibility seen = visibilityOf(image, point);
          if (seen == Visibility::AtSurface) {
            ++at_surface;
            ASSERT_TRUE(may_see) << "point " << point.transpose() << " of the ball around " << centre.transpose()
                                 << " of radius " << radius;
          }
          if (seen != Visibility::PassedThrough) continue;
          ++passed;
          ASSERT_TRUE(may) << "point " << point.transpose() << " of the ball around " << centre.transpose()
                           << " of radius " << radius;
        }
      }
    }
  EXPECT_GT(passed, 100000);
  EXPECT_GT(at_surface, 10000);
  EXPECT_GT(unseen_in_view, 5000);
  EXPECT_GT(hidden, 20000);  // an answer that is always 'may' would pass too
  EXPECT_GT(hidden_in_view, 10000);
}

/// The largest of the nearest ranges in the pixels of a box and beside it, one by one.
double farthestAround(const RangeImage& image, const PixelBox& box) {
  double farthest = 0.0;
  for (int row = box.first_row - 1; row <= box.last_row + 1; ++row)
    for (int column = box.first_column - 1; column <= box.last_column + 1; ++column)
      if (const PixelRanges ranges = image.around(row, column); !ranges.empty())
        farthest = std::max(farthest, double(ranges.nearest));
  return farthest;
}

TEST(Cullings, OverlookNoPixelAndSeldomHideLessThanTheyCould) {
  const double tolerance = 0.3;  // the default
  Random random(2);
  int seen = 0, hidden = 0, too_careful = 0;
  for (const Projection& projection :
       {Projection(lidar(16, -25, 15, 90)), Projection(lidar(33, -90, 91, 181)), Projection(lidar(1, -4, 4, 200)),
        Projection(lidar(3, -60, 60, 2)), Projection(lidar(5, -60, 60, 3)), Projection(camera())})
    for (int scene = 0; scene < 30; ++scene) {
      // A few returns, which are easily overlooked; half of them beside the cut, as are half of the balls.
      RangeImage image(projection);
      const auto rows = std::uint64_t(image.rows()), columns = std::uint64_t(image.columns());
      for (std::uint64_t i = 0, n = 1 + random.below(12); i < n; ++i) {
        const std::uint64_t column =
            i % 2 == 0 ? random.below(columns) : (random.below(5) + columns - random.below(5)) % columns;
        image.add((1.0 + 9.0 * random.uniform()) * directionOf(projection, {int(random.below(rows)), int(column)}));
      }
      const Culling culling(image);
      for (int ball = 0; ball < 300; ++ball) {
        Vector3d centre = 10.0 * random.uniform() * randomDirection(random);
        if (ball % 2 == 0) centre = {-9.0 * random.uniform(), random.normal(), 2.0 * random.normal()};
        const double radius = std::exp(1.5 * random.normal() - 1.0), nearest = centre.norm() - radius;
        const PixelBox box = pixelsOf(projection, centre, radius);
        const bool expected = !box.empty() && farthestAround(image, box) > std::max(0.0, nearest) + tolerance;
        const bool may = culling.mayPassThrough(centre, radius);
        ASSERT_TRUE(may || !expected) << centre.transpose() << " radius " << radius;
        seen += expected;
        hidden += !may;
        too_careful += may && !expected;
      }
    }
  EXPECT_GT(seen, 5000);
  EXPECT_GT(hidden, 5000);
  EXPECT_LT(too_careful, hidden / 5);
}

TEST(Cullings, HideWhatIsOutOfViewOutOfReachOrBehindAWall) {
  const RangeImage image =
      imageOf(lidar(20, -20, 20, 360), [](const Vector3d& d) { return d.x() > 0.0 ? 10.0 : 30.0; });
  const Culling culling(image);
  EXPECT_TRUE(culling.mayPassThrough({5, 0, 0}, 1.0));
  EXPECT_TRUE(culling.mayPassThrough({11, 0, 0}, 2.0));    // its near end lies before the wall
  EXPECT_FALSE(culling.mayPassThrough({12, 0, 0}, 2.0));   // its near end lies in the tolerance
  EXPECT_TRUE(culling.mayPassThrough({-12, 0, 0}, 2.0));   // there is no wall behind the sensor
  EXPECT_FALSE(culling.mayPassThrough({-35, 0, 0}, 2.0));  // farther than all returns
  EXPECT_TRUE(culling.mayPassThrough({0, 0, 0}, 1.0));     // the sensor itself
  EXPECT_FALSE(culling.mayPassThrough({5, 0, 5}, 1.0));    // too high
  EXPECT_FALSE(culling.mayPassThrough({5, 0, -5}, 1.0));
  EXPECT_TRUE(culling.mayPassThrough({5, 0, 5}, 3.0));
  EXPECT_TRUE(culling.mayPassThrough({0.5, 18, 0}, 2.0));  // reaches past the edge of the wall
  EXPECT_FALSE(culling.mayPassThrough({9, 18, 0}, 2.0));
}

TEST(Cullings, HideEverythingFromAnEmptyImage) {
  for (const Projection& projection : {Projection(lidar(8, -90, 91, 60)), Projection(camera())}) {
    const RangeImage image(projection);
    const Culling culling(image);
    EXPECT_FALSE(culling.mayPassThrough({0, 0, 0}, 5.0));
    EXPECT_FALSE(culling.mayPassThrough({0, 1, 3}, 0.5));
  }
}

/// Points 0.4 m apart on a floor of 160 m x 160 m, with some walls on it.
GaussianMap<3> largeMap() {
  std::vector<Vector<3>> points;
  for (double x = -80.0; x < 80.0; x += 0.4)
    for (double y = -80.0; y < 80.0; y += 0.4) points.emplace_back(x, y, -1.8);
  for (double x = -80.0; x < 80.0; x += 0.2)
    for (double z = -1.8; z < 3.0; z += 0.2)
      for (const double y : {-15.1, 5.1, 12.1}) points.emplace_back(x, y, z);
  return build<3>(points, MapOptions{0.4, 6, 3, 0.0});
}

std::vector<std::size_t> passedCells(const GaussianMap<3>& map, const RangeImage& image, const Pose& sensor,
                                     const std::vector<std::size_t>& cells) {
  std::vector<std::size_t> passed;
  for (const std::size_t cell : cells)
    if (visibilityOf(image, sensor.rotation.inverse() * (map.gaussian(cell, 0).mean - sensor.translation)) ==
        Visibility::PassedThrough)
      passed.push_back(cell);
  return passed;
}

TEST(VisitVisible, FindsWhatAVisitOfAllCellsFindsAndVisitsFewer) {
  const GaussianMap<3> map = largeMap();
  std::vector<std::size_t> all(map.cellCount(0));
  for (std::size_t cell = 0; cell < all.size(); ++cell) all[cell] = cell;
  Random random(3);
  std::size_t passed_in_all = 0;
  for (int trial = 0; trial < 12; ++trial) {
    Pose sensor;
    sensor.translation = {60.0 * random.uniform() - 30.0, 4.0 * random.uniform(), 0.3 * random.normal()};
    sensor.rotation = Eigen::Quaterniond(1.0, 0.02 * random.normal(), 0.02 * random.normal(), random.normal());
    sensor = normalised(sensor);
    Projection projection = lidar(32, -25, 15, 400);
    if (trial % 3 == 2) {  // a camera that looks along x of the map
      projection = camera();
      sensor.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
    }
    // The world as it is now: no floor below, the walls 1 m farther away than in the map.
    const RangeImage image = imageOf(projection, [&](const Vector3d& direction) -> std::optional<double> {
      const Vector3d in_map = sensor.rotation * direction;
      const double to_wall = ((in_map.y() > 0.0 ? 6.1 : -16.1) - sensor.translation.y()) / in_map.y();
      return to_wall < 25.0 ? std::optional(to_wall) : std::nullopt;
    });
    const Culling culling(image);
    std::vector<std::size_t> visited;
    const VisitCounts counts =
        visitVisible(MapCells{map}, culling, sensor, [&](std::size_t cell) { visited.push_back(cell); });
    EXPECT_EQ(counts.visited, visited.size());
    EXPECT_TRUE(std::is_sorted(visited.begin(), visited.end()));
    EXPECT_EQ(std::adjacent_find(visited.begin(), visited.end()), visited.end());
    const std::vector<std::size_t> passed = passedCells(map, image, sensor, all);
    EXPECT_EQ(passedCells(map, image, sensor, visited), passed);
    EXPECT_LT(counts.tested + counts.visited, all.size() / 4);
    EXPECT_GT(counts.tested, map.cellCount(2) - 1);
    passed_in_all += passed.size();
  }
  EXPECT_GT(passed_in_all, 2000u);
}

TEST(VisitVisible, VisitsAllCellsOfAMapWithOneScale) {
  const GaussianMap<3> map = build<3>(std::vector<Vector<3>>{{1, 1, 1}, {-4, 0, 2}}, MapOptions{0.5, 2, 1, 0.0});
  const RangeImage image(lidar(8, -90, 91, 60));
  std::size_t visited = 0;
  const VisitCounts counts = visitVisible(MapCells{map}, Culling(image), {}, [&](std::size_t) { ++visited; });
  EXPECT_EQ(visited, 2u);
  EXPECT_EQ(counts.tested, 0u);
}

TEST(VisitVisible, FindsNothingInAnEmptyMap) {
  const GaussianMap<3> map;
  const RangeImage image = imageOf(lidar(8, -90, 91, 60), [](const Vector3d&) { return 5.0; });
  const VisitCounts counts = visitVisible(MapCells{map}, Culling(image), {}, [](std::size_t) { FAIL(); });
  EXPECT_EQ(counts.tested + counts.visited, 0u);
}

}  // namespace
}  // namespace gaussmap
