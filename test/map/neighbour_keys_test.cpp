// SPDX-License-Identifier: BSD-3-Clause
#include "map/neighbour_keys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap {
using namespace detail;

namespace {

GaussianMap<3> mapOf(const std::vector<CellKey<3>>& keys) {
  MomentGrid<3> grid(0.5);
  CellMoments<3> one;
  one.count = 1;
  for (const CellKey<3>& key : keys) grid.add(key, one);
  return build<3>(grid, MapOptions{0.5, 6, 3, 0.0});
}

std::vector<std::size_t> nearCells(const GaussianMap<3>& map, std::size_t cell, std::int32_t from, std::int32_t to) {
  std::vector<std::size_t> found;
  forNearKeys(map.scale(0).keys[cell], from, to, [&](const CellKey<3>& key) {
    if (const auto near = map.find(key, 0)) found.push_back(*near);
  });
  std::sort(found.begin(), found.end());
  return found;
}

TEST(ForKeysAround, VisitsTheKeyAndItsNeighboursTheFirstAxisFastest) {
  std::vector<CellKey<2>> visited;
  forKeysAround<2>({5, -1}, [&](const CellKey<2>& key) { visited.push_back(key); });
  EXPECT_EQ(visited,
            (std::vector<CellKey<2>>{{4, -2}, {5, -2}, {6, -2}, {4, -1}, {5, -1}, {6, -1}, {4, 0}, {5, 0}, {6, 0}}));
  std::size_t count = 0;
  forKeysAround<3>({0, 0, 0}, [&](const CellKey<3>&) { ++count; });
  EXPECT_EQ(count, 27u);
}

TEST(ForKeysAround, LeavesOutKeysBeyond32Bits) {
  constexpr std::int32_t low = std::numeric_limits<std::int32_t>::min();
  constexpr std::int32_t high = std::numeric_limits<std::int32_t>::max();
  std::vector<CellKey<2>> visited;
  forKeysAround<2>({low, high}, [&](const CellKey<2>& key) { visited.push_back(key); });
  EXPECT_EQ(visited, (std::vector<CellKey<2>>{{low, high - 1}, {low + 1, high - 1}, {low, high}, {low + 1, high}}));
}

TEST(ForNearKeys, FindsEveryCellOfTheRingsOnce) {
  Random random(1);
  std::vector<CellKey<3>> keys;
  for (int i = 0; i < 600; ++i)
    keys.push_back({int(random.below(12)) - 6, int(random.below(12)) - 6, int(random.below(12)) - 6});
  const GaussianMap<3> map = mapOf(keys);
  for (std::size_t cell = 0; cell < map.cellCount(0); cell += 17)
    for (std::int32_t from = 1; from <= 3; ++from)
      for (std::int32_t to = from; to <= 4; ++to) {
        std::vector<std::size_t> expected;
        for (std::size_t other = 0; other < map.cellCount(0); ++other) {
          std::int32_t apart = 0;
          for (std::size_t axis = 0; axis < 3; ++axis)
            apart = std::max(apart, std::abs(map.scale(0).keys[other][axis] - map.scale(0).keys[cell][axis]));
          if (apart >= from && apart <= to) expected.push_back(other);
        }
        ASSERT_EQ(nearCells(map, cell, from, to), expected) << from << " to " << to;
      }
}

TEST(ForNearKeys, EndsWhereTheKeysEnd) {
  constexpr std::int32_t low = std::numeric_limits<std::int32_t>::min();
  constexpr std::int32_t high = std::numeric_limits<std::int32_t>::max();
  const GaussianMap<3> map = mapOf({{low, low, low}, {low + 1, low, low}, {high, high, high}, {high, high, high - 2}});
  const auto at = [&](const CellKey<3>& key) { return *map.find(key, 0); };
  using Cells = std::vector<std::size_t>;
  EXPECT_EQ(nearCells(map, at({low, low, low}), 1, 3), Cells{at({low + 1, low, low})});
  EXPECT_EQ(nearCells(map, at({high, high, high}), 1, 3), Cells{at({high, high, high - 2})});
}

TEST(CellsFor, IsTheNearestNumberOfCellsButNeverNone) {
  EXPECT_EQ(cellsFor(0.0, 0.2), 1);
  EXPECT_EQ(cellsFor(0.2, 0.2), 1);
  EXPECT_EQ(cellsFor(0.2, 0.1), 2);
  EXPECT_EQ(cellsFor(0.2, 1.0), 1);
  EXPECT_EQ(cellsFor(0.6, 0.1), 6);
  EXPECT_EQ(cellsFor(0.6, 0.25), 2);
}

}  // namespace
}  // namespace gaussmap
