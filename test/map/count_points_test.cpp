// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/map/moment_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Returns records of `stride` floats, x y z first. One point in 50 is not finite.
std::vector<float> randomRecords(std::size_t count, std::size_t stride, double extent) {
  Random random(7);
  std::vector<float> records(count * stride);
  for (float& value : records) value = static_cast<float>(extent * (2.0 * random.uniform() - 1.0));
  for (std::size_t i = 0; i < count; ++i)
    if (random.below(50) == 0) records[i * stride + random.below(3)] = kNaN;
  return records;
}

MomentGrid<3> oneByOne(const PointsView& points, double resolution) {
  MomentGrid<3> grid(resolution);
  grid.addPoints(points.count, [&](std::size_t i) { return points[i]; });
  return grid;
}

void expectEqual(const MomentGrid<3>& grid, const MomentGrid<3>& expected) {
  ASSERT_EQ(grid.size(), expected.size());
  EXPECT_EQ(grid.pointCount(), expected.pointCount());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const CellMoments<3>* const moments = grid.find(expected[i].key);
    ASSERT_NE(moments, nullptr) << toString<3>(expected[i].key);
    ASSERT_EQ(*moments, expected[i].moments) << toString<3>(expected[i].key);
  }
}

TEST(CountPoints, GivesTheSumsOfTheSinglePointsForAnyRecordAndThreads) {
  for (const std::size_t stride : {3u, 4u, 5u, 8u}) {
    const std::vector<float> records = randomRecords(200001, stride, 3.0);
    const PointsView points{records.data(), 200001, stride};
    const MomentGrid<3> expected = oneByOne(points, 0.1);
    for (const int threads : {0, 1, 2}) expectEqual(countPoints(0.1, points, threads), expected);
  }
}

TEST(CountPoints, GivesTheSameForThreadsThatMeetCellsBySharesOrAlone) {  // more cells than a chunk holds
  const std::vector<float> records = randomRecords(400000, 4, 4.0);
  const PointsView points{records.data(), 400000, 4};
  const MomentGrid<3> expected = oneByOne(points, 0.08);
  EXPECT_GT(expected.size(), 300000u);
  expectEqual(countPoints(0.08, points, 2), expected);
}

TEST(CountPoints, OfNoPointsAndOfNoneThatIsFiniteIsEmpty) {
  EXPECT_TRUE(countPoints(0.1, {}).empty());
  const std::vector<float> none(30, kNaN);
  EXPECT_TRUE(countPoints(0.1, {none.data(), 10, 3}).empty());
}

TEST(CountPoints, RefusesAPointTooFarForTheCellsAndNamesIt) {
  const std::vector<float> far{0.0f, 1.0f, 2.0f, 1e30f, 0.0f, 0.0f};
  try {
    countPoints(0.1, {far.data(), 2, 3});
    FAIL();
  } catch (const std::out_of_range& error) {
    EXPECT_NE(std::string(error.what()).find("e+30"), std::string::npos) << error.what();
  }
  EXPECT_THROW(countPoints(0.0, {}), std::invalid_argument);
}

TEST(MomentGrids, MergedByThreadsAreTheGridOfAll) {
  const std::vector<float> records = randomRecords(300000, 3, 4.0);
  const MomentGrid<3> expected = oneByOne({records.data(), 300000, 3}, 0.1);
  for (const std::size_t first : {0u, 1u, 1000u, 150000u, 299999u})
    for (const int threads : {1, 2}) {
      MomentGrid<3> merged = oneByOne({records.data(), first, 3}, 0.1);
      merged.merge(oneByOne({records.data() + 3 * first, 300000 - first, 3}, 0.1), threads);
      expectEqual(merged, expected);
      merged.merge(MomentGrid<3>(0.1), threads);
      expectEqual(merged, expected);
    }
}

TEST(MomentGrid, HoldsWhatItsCellsTake) {
  const std::vector<float> records = randomRecords(400000, 3, 4.0);
  const MomentGrid<3> grid = oneByOne({records.data(), 400000, 3}, 0.08);
  EXPECT_GE(grid.memoryBytes(), grid.size() * (sizeof(MomentGrid<3>::Cell) + 8));
  EXPECT_LE(grid.memoryBytes(), grid.size() * (sizeof(MomentGrid<3>::Cell) + 26));
  EXPECT_LT(MomentGrid<3>(0.1).memoryBytes(), 10000u);
}

}  // namespace
}  // namespace gaussmap
