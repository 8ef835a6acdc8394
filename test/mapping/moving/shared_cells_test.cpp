// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/moving/shared_cells.h"

#include <gtest/gtest.h>

#include "gaussmap/mapping/build.h"

namespace gaussmap {
using namespace detail;

namespace {

using Points = std::vector<Vector<3>>;
constexpr double kSide = 0.25;

GaussianMap<3> mapOf(const Points& points) {
  return build<3>(points, MapOptions{kSide, 6, 3, 0.0});
}

std::size_t cellAt(const GaussianMap<3>& map, const Vector<3>& point) {
  return *map.find(map.grid().keyOf(point), 0);
}

/// Points 5 cm apart on z = height + slope x, over |x|, |y| < half.
Points patch(double half, double height, double slope) {
  Points points;
  for (double x = -half + 0.01; x < half; x += 0.05)
    for (double y = -half + 0.01; y < half; y += 0.05) points.emplace_back(x, y, height + slope * x);
  return points;
}

/// The surface that is found for the cell of a point that an object was in, nothing else known of it.
std::optional<Surface<3>> surfaceAt(const Points& points, const Vector<3>& object,
                                    const SharedCellOptions& options = {}) {
  Points all = points;
  all.push_back(object);
  const GaussianMap<3> map = mapOf(all);
  SharedCells shared = {{cellAt(map, object), {3, 5}}};
  fitSurfaces(map, MomentGrid<3>(kSide), options, 1, shared);
  return shared.begin()->second.surface;
}

TEST(FindSharedCells, AreTheCellsOfObjectsAndThoseBeside) {
  const GaussianMap<3> map =
      mapOf({{0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.6, 0.1, 0.1}, {0.8, 0.1, 0.1}, {1.3, 0.1, 0.1}});
  std::vector<bool> moving(5);
  std::vector<Evidence> evidence(5);
  const auto object = [&](double x, std::uint32_t first, std::uint32_t last) {
    const std::size_t cell = cellAt(map, {x, 0.1, 0.1});
    moving[cell] = true;
    evidence[cell] = {2, 9, first, last};
  };
  object(0.1, 4, 6);
  object(0.6, 2, 5);
  const SharedCells shared = findSharedCells(map, moving, evidence);
  ASSERT_EQ(shared.size(), 4u);
  const auto expect = [&](const Vector<3>& point, std::uint32_t first, std::uint32_t last) {
    const SharedCell& cell = shared.at(cellAt(map, point));
    EXPECT_EQ(cell.first_scan, first);
    EXPECT_EQ(cell.last_scan, last);
    EXPECT_FALSE(cell.surface);
  };
  expect({0.1, 0.1, 0.1}, 4, 6);
  expect({0.3, 0.3, 0.3}, 2, 6);  // beside both
  expect({0.6, 0.1, 0.1}, 2, 5);
  expect({0.8, 0.1, 0.1}, 2, 5);
}

TEST(FitSurfaces, FindsThePlaneOfTheCellsAround) {
  const Vector<3> object(0.1, 0.1, 0.2);
  for (const double slope : {0.0, 0.1, -0.3}) {
    const auto surface = surfaceAt(patch(0.5, 0.1, slope), object);
    ASSERT_TRUE(surface);
    const Eigen::Vector3d normal = Eigen::Vector3d(-slope, 0.0, 1.0).normalized();
    EXPECT_NEAR(std::abs(surface->normal.dot(normal)), 1.0, 1e-6);
    // The point on it is given about the centre of the cell, (0.125, 0.125, 0.125).
    EXPECT_NEAR(normal.dot(surface->point + Eigen::Vector3d(0.125, 0.125, 0.025)), 0.0, 1e-4);
    EXPECT_NEAR(surface->deviation, 0.0, 1e-4);
  }
}

TEST(FitSurfaces, FindsItAsFarAsItReaches) {
  Points far;
  for (const Vector<3>& point : patch(2.0, 0.1, 0.0))
    if (point.head<2>().cwiseAbs().maxCoeff() > 0.8) far.push_back(point);
  SharedCellOptions options;
  EXPECT_FALSE(surfaceAt(far, {0.1, 0.1, 0.2}, options));
  options.reach = 1.0;
  EXPECT_TRUE(surfaceAt(far, {0.1, 0.1, 0.2}, options));
}

TEST(FitSurfaces, TakesTheNearestFlatPiece) {  // a step 0.3 m away
  Points points = patch(0.3, 0.1, 0.0);
  for (Vector<3> point : patch(1.0, 0.0, 0.0))
    if (point.head<2>().cwiseAbs().maxCoeff() > 0.3) points.push_back(point + Vector<3>(0, 0, 0.6));
  const auto surface = surfaceAt(points, {0.1, 0.1, 0.2});
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->point.z(), -0.025, 1e-4);
}

TEST(FitSurfaces, FindsNoneInLinesHeapsAndFewPoints) {
  const Vector<3> object(0.1, 0.1, 0.2);
  Points line, heap, few = patch(0.5, 0.1, 0.0);
  Random random(1);
  for (double y = -0.5; y < 0.5; y += 0.01) line.emplace_back(-0.1, y, 0.1);
  for (int i = 0; i < 2000; ++i)
    heap.emplace_back(1.5 * random.uniform() - 0.7, 1.5 * random.uniform() - 0.7, 1.5 * random.uniform() - 0.7);
  few.resize(9);
  EXPECT_FALSE(surfaceAt(line, object));
  EXPECT_FALSE(surfaceAt(heap, object));
  EXPECT_FALSE(surfaceAt(few, object));
  EXPECT_FALSE(surfaceAt({}, object));
}

TEST(FitSurfaces, TakesFromSharedCellsOnlyThePointsThatHoldStill) {
  Points floor = patch(0.6, 0.1, 0.0), all = floor;
  Random random(2);
  for (int i = 0; i < 4000; ++i)  // the object
    all.emplace_back(1.2 * random.uniform() - 0.6, 1.2 * random.uniform() - 0.6, 0.25 * random.uniform());
  const GaussianMap<3> map = mapOf(all);
  SharedCells shared;
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) shared.try_emplace(cell, SharedCell{0, 1});
  SharedCells without = shared;
  fitSurfaces(map, MomentGrid<3>(kSide), {}, 1, without);
  for (const auto& [cell, entry] : without) EXPECT_FALSE(entry.surface);
  MomentGrid<3> still(kSide);
  still.addPoints(floor);
  fitSurfaces(map, still, {}, 2, shared);
  for (const auto& [cell, entry] : shared) {
    ASSERT_TRUE(entry.surface);
    EXPECT_NEAR(std::abs(entry.surface->normal.z()), 1.0, 1e-9);
    EXPECT_NEAR(entry.surface->point.z(), 0.1 - 0.125, 1e-4);
  }
}

}  // namespace
}  // namespace gaussmap
