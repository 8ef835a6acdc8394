// SPDX-License-Identifier: BSD-3-Clause
#include "segments/explained_score.h"

#include <gtest/gtest.h>

namespace gaussmap::detail {
namespace {

CellRow randomRow(Random& random, int cells) {
  CellRow row({0.0, 0.0}, {1.0, 0.0}, 0.1);
  for (int i = 0; i < cells; ++i) {
    SegmentCell& cell = row.at(i);
    if (random.uniform() < 0.7) cell.hits.add({0.1 * i + 0.05, 0.08 * random.normal()}, 5.0 * random.uniform());
    if (random.uniform() < 0.5) cell.crossed = 10.0 * random.uniform();
  }
  return row;
}

/// The highest score over all sets of cells.
double highestScore(const CellRow& row, const LineFit& line, const ExplainedScore& score) {
  const std::size_t count = row.cells().size();
  double highest = 0.0;
  for (std::uint32_t set = 0; set < (1u << count); ++set) {
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!(set >> i & 1u)) continue;
      if (i == 0 || !(set >> (i - 1) & 1u)) sum -= score.segment_cost;
      sum -= score.costOfCell(row.cells(), i);
      if (row.cells()[i].hits.n > 0.0) sum += score.explained(row.cells()[i].hits, line);
    }
    highest = std::max(highest, sum);
  }
  return highest;
}

TEST(BestRanges, IsAsGoodAsTheBestOfAllSetsOfCells) {
  Random random(1);
  const LineFit line;
  std::size_t several = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const CellRow row = randomRow(random, 10);
    const ExplainedScore score{0.1, 1.5 * random.uniform(), 0.3, 0.5, 0.2};
    const std::vector<ScoredRange> ranges = bestRanges(row, line, score);
    double sum = 0.0;
    std::size_t before = 0;
    for (const ScoredRange& range : ranges) {
      EXPECT_LE(before, range.first);
      EXPECT_LT(range.first, range.last);
      EXPECT_GT(range.score, 0.0);
      sum += range.score;
      before = range.last + 1;
    }
    EXPECT_NEAR(sum, highestScore(row, line, score), 1e-9);
    several += ranges.size() > 1;
  }
  EXPECT_GT(several, 20u);
}

TEST(BestRanges, CutsADoorOutOfAWall) {
  CellRow row({0.0, 0.0}, {1.0, 0.0}, 0.1);
  for (int i = 0; i < 30; ++i) {
    SegmentCell& cell = row.at(i);
    const bool door = i >= 10 && i < 19;
    if (!door) cell.hits.add({0.1 * i + 0.05, 0.0}, 20.0);
    if (door) cell.crossed = 100.0;
  }
  const std::vector<ScoredRange> ranges = bestRanges(row, LineFit(), {0.1, 10.0, 0.1, 1.0, 0.1});
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_EQ(ranges[0].last, 10u);
  EXPECT_EQ(ranges[1].first, 19u);
}

TEST(ExplainedScore, AnObservationCountsOneOnTheLineAndNothingAtTheTolerance) {
  const ExplainedScore score{0.1, 0.0, 0.0, 0.0, 0.0};
  const auto at = [](double distance) {
    LineMoments hits;
    hits.add({3.0, distance}, 2.0);
    return hits;
  };
  EXPECT_DOUBLE_EQ(score.explained(at(0.0), LineFit()), 2.0);
  EXPECT_NEAR(score.explained(at(0.05), LineFit()), 2.0 * (1.0 - 1.0 / 64.0), 1e-12);
  EXPECT_DOUBLE_EQ(score.explained(at(0.1001), LineFit()), 0.0);
  EXPECT_DOUBLE_EQ(score.explained(at(5.0), LineFit()), 0.0);
}

}  // namespace
}  // namespace gaussmap::detail
