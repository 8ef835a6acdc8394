// SPDX-License-Identifier: BSD-3-Clause
#include "clustering/merge_gains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

/// A dendrogram whose merges, the last one first, cost this.
Dendrogram dendrogramOf(const std::vector<double>& costs_from_the_top) {
  Dendrogram dendrogram{costs_from_the_top.size() + 1, {}};
  for (auto cost = costs_from_the_top.rbegin(); cost != costs_from_the_top.rend(); ++cost)
    dendrogram.merges.push_back({0, 0, *cost});
  return dendrogram;
}

std::vector<double> gains(const std::vector<double>& costs_from_the_top) {
  return mergeGains(dendrogramOf(costs_from_the_top));
}

TEST(MergeGains, AreTheCostsWhereTheyFallFromTheTop) {
  EXPECT_TRUE(gains({}).empty());
  EXPECT_EQ(gains({3}), (std::vector<double>{3}));
  EXPECT_EQ(gains({3, 2, 2, -1}), (std::vector<double>{3, 2, 2, -1}));
}

TEST(MergeGains, ShareTheDearMergeWithTheCheapOnesBeforeIt) {
  EXPECT_EQ(gains({1, 5}), (std::vector<double>{3, 3}));
  EXPECT_EQ(gains({4, 1, 1, 7, 2}), (std::vector<double>{4, 3, 3, 3, 2}));
  EXPECT_EQ(gains({4, 1, 1, 13, 2}), (std::vector<double>{4.75, 4.75, 4.75, 4.75, 2}));
}

TEST(PartsPerCell, AreTakenWhereTheGainIsLargest) {
  const std::vector<std::vector<double>> cells = {gains({1, 5}), gains({2}), {}, gains({2, 2})};
  using Parts = std::vector<std::size_t>;
  EXPECT_EQ(partsPerCell(cells, 0), (Parts{1, 1, 1, 1}));
  EXPECT_EQ(partsPerCell(cells, 2), (Parts{3, 1, 1, 1}));
  EXPECT_EQ(partsPerCell(cells, 3), (Parts{3, 2, 1, 1}));  // a tie: the smaller cell
  EXPECT_EQ(partsPerCell(cells, 5), (Parts{3, 2, 1, 3}));
  EXPECT_EQ(partsPerCell(cells, 99), (Parts{3, 2, 1, 3}));
}

TEST(PartsPerCell, SaveAsMuchAsTheBestOfAllAllocations) {
  // Where the greedy choice stops at the end of a block it is the optimum, by dynamic programming over the cells.
  Random random(1);
  int compared = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<std::vector<double>> costs(1 + random.below(5)), all_gains;
    std::vector<double> sorted;
    for (std::vector<double>& cell : costs) {
      for (std::size_t i = random.below(7); i > 0; --i) cell.push_back(10.0 * random.uniform() - 1.0);
      all_gains.push_back(gains(cell));
      sorted.insert(sorted.end(), all_gains.back().begin(), all_gains.back().end());
    }
    std::sort(sorted.rbegin(), sorted.rend());
    for (std::size_t extra = 1; extra < sorted.size(); ++extra) {
      if (sorted[extra - 1] == sorted[extra]) continue;
      std::vector<double> best(extra + 1, -1e300);
      best[0] = 0.0;
      for (const std::vector<double>& cell : costs)
        for (std::size_t used = extra; used > 0; --used) {
          double saved = 0.0;
          for (std::size_t here = 1; here <= std::min(used, cell.size()); ++here) {
            saved += cell[here - 1];
            best[used] = std::max(best[used], best[used - here] + saved);
          }
        }
      const std::vector<std::size_t> parts = partsPerCell(all_gains, extra);
      double saved = 0.0;
      for (std::size_t c = 0; c < costs.size(); ++c)
        saved = std::accumulate(costs[c].begin(), costs[c].begin() + static_cast<std::ptrdiff_t>(parts[c] - 1), saved);
      EXPECT_NEAR(saved, best[extra], 1e-12);
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
}

}  // namespace
}  // namespace gaussmap
