// SPDX-License-Identifier: BSD-3-Clause
#include "points/plane_batch.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

namespace gaussmap {
using namespace detail;

namespace {

using Point = std::array<float, 4>;

/// Whole numbers, whose sums no order rounds, and padding that would show.
std::vector<Point> wholePoints(std::size_t count) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> place(-1000, 1000);
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({float(place(random)), float(place(random)), float(place(random)), 1.0f});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  points.resize(count + PlaneSums::kPadding, {nan, nan, nan, nan});
  return points;
}

void expectSums(const std::vector<Point>& points, const PlaneRanges& ranges) {
  std::array<double, 12> expected{};
  double count = 0.0;
  const Point about = points[ranges.first(0)];
  for (std::size_t range = 0; range < ranges.size(); ++range)
    for (std::uint32_t i = ranges.first(range); i < ranges.last(range); ++i) {
      const double p[4] = {double(points[i][0] - about[0]), double(points[i][1] - about[1]),
                           double(points[i][2] - about[2]), 1.0};
      for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column) expected[4 * row + column] += p[row] * p[column];
      count += 1.0;
    }
  const PlaneSums sums = sumUp(points.data(), ranges);
  EXPECT_EQ(sums.product, expected);
  EXPECT_EQ(sums.count, count);
}

TEST(PlaneSums, AreThoseOfAPlainLoopForAnyNumberOfPoints) {
  for (const std::uint32_t count : {1u, 2u, 7u, 8u, 9u, 247u, 248u, 249u, 255u, 256u, 257u, 4099u}) {
    PlaneRanges ranges;
    PlaneRanges::Adder(ranges).add(0, count);
    expectSums(wholePoints(count), ranges);
  }
}

TEST(PlaneSums, AreThoseOfAPlainLoopForAsManyRangesAsThereCanBe) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 50; ++round) {
    PlaneRanges ranges;
    std::uint32_t at = 3;
    while (ranges.size() < PlaneRanges::kCapacity) {
      const auto size = std::uint32_t(1 + random() % (round % 2 ? 5 : 40));
      PlaneRanges::Adder(ranges).add(at, at + size);
      at += size + 1;
    }
    expectSums(wholePoints(at - 1), ranges);
  }
}

TEST(PlaneRanges, AreJoinedWhereOneFollowsAnother) {
  PlaneRanges ranges;
  {
    PlaneRanges::Adder adder(ranges);
    EXPECT_EQ(adder.add(4, 9), 5u);
    EXPECT_EQ(adder.add(9, 10), 1u);
    EXPECT_EQ(adder.add(12, 15), 3u);
  }
  EXPECT_EQ(PlaneRanges::Adder(ranges).add(15, 17), 2u);  // joins what another has added
  EXPECT_EQ(PlaneRanges::Adder(ranges).add(3, 4), 1u);
  ASSERT_EQ(ranges.size(), 3u);
  EXPECT_EQ(ranges.first(0), 4u);
  EXPECT_EQ(ranges.last(0), 10u);
  EXPECT_EQ(ranges.last(1), 17u);
  EXPECT_EQ(ranges.first(2), 3u);
  ranges.clear();
  EXPECT_EQ(ranges.size(), 0u);
  PlaneRanges::Adder(ranges).add(4, 6);  // follows the last one from before, which is gone
  ASSERT_EQ(ranges.size(), 1u);
  EXPECT_EQ(ranges.first(0), 4u);
}

}  // namespace
}  // namespace gaussmap
