// SPDX-License-Identifier: BSD-3-Clause
#include "points/morton_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace gaussmap {
using namespace detail;

namespace {

TEST(CubeWithoutStrays, LeavesOutTheOutermostHundredthInAnyOrder) {
  std::vector<std::array<float, 3>> points = {{1e7f, 0.0f, 0.0f}};
  for (int i = 0; i < 1000; ++i) points.push_back({float(i), 0.0f, 0.0f});
  std::mt19937_64 random(1);
  for (int order = 0; order < 20; ++order) {
    const PointsView view{points[0].data(), points.size(), 3};
    const Cube cube = withoutStrays(cubeOf(view, view), view);
    EXPECT_EQ(cube.side, 21.0 * 980.0);  // from 10 to 990
    EXPECT_EQ(cube.low.x(), 500.0 - 10.5 * 980.0);
    std::shuffle(points.begin(), points.end(), random);
  }
}

TEST(CubeWithoutStrays, IsTheWholeOneWhereNothingLiesFarOff) {
  std::vector<std::array<float, 3>> points;
  for (int i = 0; i < 1000; ++i) points.push_back({float(i), 0.0f, 0.0f});
  const PointsView view{points[0].data(), points.size(), 3};
  EXPECT_EQ(withoutStrays(cubeOf(view, view), view).side, 999.0);
}

TEST(SortedPoints, AreThoseWithinTheCubeInTheOrderOfTheirCodes) {
  std::vector<std::array<float, 3>> points;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<float> place(-0.5f, 1.5f);
  for (int i = 0; i < 10000; ++i) points.push_back({place(random), place(random), place(random)});
  points[17][1] = std::numeric_limits<float>::quiet_NaN();
  const Cube cube;  // 0 ... 1
  const SortedBlocks sorted({points[0].data(), points.size(), 3}, cube, 2);
  std::size_t inside = 0;
  for (const auto& p : points)
    inside += std::all_of(p.begin(), p.end(), [](float x) { return x >= 0.0f && x <= 1.0f; });
  ASSERT_EQ(sorted.items.size(), inside);
  for (std::size_t i = 0; i < inside; ++i) {
    const auto& p = points[sorted.items[i].index];
    EXPECT_EQ(sorted.points[i], (std::array<float, 4>{p[0], p[1], p[2], 1.0f}));
    EXPECT_EQ(sorted.items[i].code, cube.codeOf(p.data(), cube.cellsPerMetre()));
    EXPECT_TRUE(i == 0 || sorted.items[i - 1].code <= sorted.items[i].code);
  }
}

TEST(OctantsOfARange, AreCountedRightWhateverItsSize) {
  constexpr int kShift = 6;
  std::mt19937_64 random(3);
  for (const std::uint32_t size : {0u, 1u, 2u, 127u, 128u, 129u, 1000u})
    for (const std::uint64_t octants : {1u, 8u, 0u}) {  // all in the first, any, all in the last
      MortonItems items(size + 10);
      for (std::uint32_t i = 0; i < items.size(); ++i)
        items[i] = {octants == 0 ? 7u << kShift : random() % octants << kShift | random() % 64, i};
      std::sort(items.begin() + 5, items.begin() + 5 + size,
                [](const MortonItem& a, const MortonItem& b) { return a.code < b.code; });
      const auto borders = octantsOf(items, {5, 5 + size}, kShift);
      for (std::uint32_t k = 0; k <= 8; ++k)
        EXPECT_EQ(borders[k], 5 + std::count_if(items.begin() + 5, items.begin() + 5 + size,
                                                [&](const MortonItem& item) { return item.code >> kShift < k; }));
    }
}

}  // namespace
}  // namespace gaussmap
