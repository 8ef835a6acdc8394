// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/moment_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace gaussmap {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

template <int D>
std::vector<Vector<D>> randomPoints(std::size_t count, double extent, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vector<D>> points(count);
  for (Vector<D>& point : points)
    for (int axis = 0; axis < D; ++axis) point(axis) = extent * (2.0 * random.uniform() - 1.0);
  return points;
}

template <int D>
std::map<CellKey<D>, CellMoments<D>> contents(const MomentGrid<D>& grid) {
  std::map<CellKey<D>, CellMoments<D>> cells;
  for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_TRUE(cells.emplace(grid[i].key, grid[i].moments).second);
  return cells;
}

template <int D>
MomentGrid<D> gridOf(const std::vector<Vector<D>>& points, double resolution) {
  MomentGrid<D> grid(resolution);
  grid.addPoints(points);
  return grid;
}

/// The definition, point by point, in long double: no lattice, no hash.
template <int D>
void expectEqualToLongDoubleReference(double resolution, double extent, const Vector<D>& origin) {
  std::map<CellKey<D>, std::vector<Vector<D>>> reference;
  std::vector<Vector<D>> points = randomPoints<D>(20000, extent, 5);
  const Grid<D> geometry({resolution, 2, 1, 0.0});
  for (Vector<D>& point : points) {
    point += origin;
    CellKey<D> key = geometry.keyOf(point);
    for (int axis = 0; axis < D; ++axis) {
      const long double exact = static_cast<long double>(point(axis)) / static_cast<long double>(resolution);
      const auto index = static_cast<std::size_t>(axis);
      // Up to the half step by which a point may snap over a border.
      EXPECT_NEAR(static_cast<double>(std::floor(exact + 0x1.0p-17L) - static_cast<long double>(key[index])), 0.0, 1e-9)
          << point.transpose();
    }
    reference[key].push_back(point);
  }
  const auto cells = contents<D>(gridOf<D>(points, resolution));
  ASSERT_EQ(cells.size(), reference.size());
  for (const auto& entry : reference) {
    const CellKey<D>& key = entry.first;
    const std::vector<Vector<D>>& in_cell = entry.second;
    const CellMoments<D>& moments = cells.at(key);
    const auto n = static_cast<long double>(in_cell.size());
    ASSERT_EQ(moments.count, static_cast<std::int64_t>(in_cell.size()));
    long double mean[D] = {};
    for (const Vector<D>& point : in_cell)
      for (int axis = 0; axis < D; ++axis)
        mean[axis] +=
            (static_cast<long double>(point(axis)) -
             (static_cast<long double>(key[std::size_t(axis)]) + 0.5L) * static_cast<long double>(resolution)) /
            n;
    for (int row = 0; row < D; ++row) {
      EXPECT_NEAR(moments.mean(resolution)(row), static_cast<double>(mean[row]), 1e-5 * resolution);
      for (int column = 0; column < D; ++column) {
        long double product = 0.0L;
        for (const Vector<D>& point : in_cell) {
          const auto offset = [&](int axis) {
            return static_cast<long double>(point(axis)) -
                   (static_cast<long double>(key[std::size_t(axis)]) + 0.5L) * static_cast<long double>(resolution) -
                   mean[axis];
          };
          product += offset(row) * offset(column) / n;
        }
        EXPECT_NEAR(moments.covariance(resolution)(row, column), static_cast<double>(product),
                    1e-5 * resolution * resolution);
      }
    }
  }
}

TEST(MomentGrid, EqualsALongDoubleReferenceIn3D) {
  expectEqualToLongDoubleReference<3>(0.1, 1.0, Vector<3>::Zero());
  expectEqualToLongDoubleReference<3>(0.37, 5.0, Vector<3>::Zero());
}
TEST(MomentGrid, EqualsALongDoubleReferenceIn2D) {
  expectEqualToLongDoubleReference<2>(0.05, 1.0, Vector<2>::Zero());
}
TEST(MomentGrid, EqualsALongDoubleReferenceTenThousandKilometresAway) {
  expectEqualToLongDoubleReference<3>(0.25, 2.0, Vector<3>(1e7, -1e7, 5e6));
}

TEST(MomentGrid, PutsNegativeCoordinatesIntoNegativeCells) {
  const auto cells = contents<3>(gridOf<3>({{-0.05, 0.05, -1.0}}, 0.1));
  EXPECT_EQ(cells.begin()->first, (CellKey<3>{-1, 0, -10}));
}

TEST(MomentGrid, DoesNotDependOnTheOrderOfPoints) {
  std::vector<Vector<3>> points = randomPoints<3>(30000, 2.0, 1);
  const auto expected = contents<3>(gridOf<3>(points, 0.2));
  Random random(2);
  for (int trial = 0; trial < 5; ++trial) {
    for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
    EXPECT_EQ(contents<3>(gridOf<3>(points, 0.2)), expected);
  }
}

TEST(MomentGrid, OfPartsMergedInAnyOrderIsTheGridOfAll) {
  const std::vector<Vector<3>> points = randomPoints<3>(30000, 2.0, 3);
  const auto expected = contents<3>(gridOf<3>(points, 0.2));
  Random random(4);
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<std::vector<Vector<3>>> parts(1 + random.below(6));
    for (const Vector<3>& point : points) parts[random.below(parts.size())].push_back(point);
    MomentGrid<3> merged(0.2);
    std::rotate(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(random.below(parts.size())), parts.end());
    for (const auto& part : parts) merged.merge(gridOf<3>(part, 0.2));
    EXPECT_EQ(contents<3>(merged), expected);
    EXPECT_EQ(merged.pointCount(), 30000);
  }
}

TEST(MomentGrid, CountsPointsOfAScanLineAsPointsInAnyOrder) {  // long runs in one cell, then back again
  std::vector<Vector<3>> points;
  for (int pass = 0; pass < 3; ++pass)
    for (int i = -3000; i < 3000; ++i) points.emplace_back(0.001 * i, 0.0, 0.0);
  const auto cells = contents<3>(gridOf<3>(points, 1.0));
  ASSERT_EQ(cells.size(), 6u);
  for (const auto& [key, moments] : cells) EXPECT_EQ(moments.count, 3000) << toString<3>(key);
}

TEST(MomentGrid, LeavesOutNonFinitePoints) {
  MomentGrid<3> grid(0.1);
  EXPECT_EQ(grid.addPoints({{kNaN, 0, 0}, {0, kInf, 0}, {0, 0, -kInf}, {1, 1, 1}}), 1u);
  EXPECT_EQ(grid.pointCount(), 1);
  EXPECT_EQ(grid.addPoints({{kNaN, kNaN, kNaN}}), 0u);
  EXPECT_EQ(grid.addPoints(std::vector<Vector<3>>{}), 0u);
}

TEST(MomentGrid, RefusesAPointThatDoesNotFitAndNamesIt) {
  MomentGrid<3> grid(1e-4);
  try {
    grid.addPoints({{1, 1, 1}, {kNaN, 0, 0}, {3e5, 0, 7}});
    FAIL();
  } catch (const std::out_of_range& error) {
    EXPECT_NE(std::string(error.what()).find("(300000, 0, 7)"), std::string::npos) << error.what();
  }
  EXPECT_EQ(grid.pointCount(), 0) << "a block is counted whole or not at all";
  EXPECT_THROW(grid.addPoints({{1e300, 0, 0}}), std::out_of_range);
}

TEST(MomentGrid, RefusesCellsOfAnotherSize) {
  MomentGrid<3> grid(0.1);
  EXPECT_THROW(grid.merge(MomentGrid<3>(0.2)), std::invalid_argument);
  EXPECT_THROW(MomentGrid<3>(0.0), std::invalid_argument);
  EXPECT_THROW(MomentGrid<3>{kNaN}, std::invalid_argument);
}

TEST(MomentGrid, AgreesWithTheGridOnWhereAPointLies) {
  const Grid<3> geometry({0.1, 10, 1, 0.0});
  Random random(6);
  for (int i = 0; i < 20000; ++i) {
    Vector<3> point;  // close to cell borders, where rounding decides
    for (int axis = 0; axis < 3; ++axis)
      point(axis) = 0.1 * static_cast<double>(random.below(2001)) - 100.0 + 2e-6 * random.normal();
    EXPECT_EQ(contents<3>(gridOf<3>({point}, 0.1)).begin()->first, geometry.keyOf(point));
  }
}

}  // namespace
}  // namespace gaussmap
