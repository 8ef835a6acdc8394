// SPDX-License-Identifier: BSD-3-Clause
#include "clustering/ward.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/morton.h"
#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {
namespace {

WardCluster clusterAt(double x, double y, double z, double weight) {
  return {x, y, z, weight, mortonCode(std::uint64_t(x), std::uint64_t(y), std::uint64_t(z))};
}

/// Clusters in different unit cells of a cube, sorted by code.
std::vector<WardCluster> randomClusters(std::size_t count, double side, std::uint64_t seed) {
  Random random(seed);
  std::vector<WardCluster> clusters;
  for (std::size_t i = 0; i < count; ++i)
    clusters.push_back(clusterAt(side * random.uniform(), side * random.uniform(), side * random.uniform(),
                                 1.0 + std::floor(20 * random.uniform())));
  std::sort(clusters.begin(), clusters.end(), [](auto& a, auto& b) { return a.code < b.code; });
  clusters.erase(std::unique(clusters.begin(), clusters.end(), [](auto& a, auto& b) { return a.code == b.code; }),
                 clusters.end());
  return clusters;
}

/// Merges the cheapest of all pairs until `count` clusters are left.
std::vector<std::uint32_t> greedyCut(std::vector<WardCluster> clusters, std::size_t count) {
  std::vector<std::uint32_t> unions(clusters.size());
  for (std::size_t i = 0; i < unions.size(); ++i) unions[i] = std::uint32_t(i);
  for (std::size_t left = clusters.size(); left > count; --left) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t first = 0, second = 0;
    for (std::size_t a = 0; a < clusters.size(); ++a)
      for (std::size_t b = a + 1; b < clusters.size(); ++b) {
        if (unions[a] != a || unions[b] != b) continue;
        const double square = std::pow(clusters[a].x - clusters[b].x, 2) + std::pow(clusters[a].y - clusters[b].y, 2) +
                              std::pow(clusters[a].z - clusters[b].z, 2);
        const double cost =
            clusters[a].weight * clusters[b].weight / (clusters[a].weight + clusters[b].weight) * square;
        if (cost >= least) continue;
        least = cost;
        first = a;
        second = b;
      }
    const double share = clusters[second].weight / (clusters[first].weight + clusters[second].weight);
    clusters[first].x += share * (clusters[second].x - clusters[first].x);
    clusters[first].y += share * (clusters[second].y - clusters[first].y);
    clusters[first].z += share * (clusters[second].z - clusters[first].z);
    clusters[first].weight += clusters[second].weight;
    for (std::uint32_t& one : unions)
      if (one == second) one = std::uint32_t(first);
  }
  std::uint32_t next = 0;
  std::vector<std::uint32_t> numbers(clusters.size());
  for (std::size_t i = 0; i < unions.size(); ++i) numbers[i] = unions[i] == i ? next++ : numbers[unions[i]];
  return numbers;
}

TEST(WardMerges, MergesTwoNearPairsBeforeFarOnes) {
  // Costs: 1 between the first two, 4 * 10 * 10 / 20 = 20 between the last two, and far more between the pairs.
  const std::vector<WardCluster> clusters = {clusterAt(0.5, 0.5, 0.5, 2), clusterAt(1.5, 0.5, 0.5, 2),
                                             clusterAt(40.5, 0.5, 0.5, 10), clusterAt(42.5, 0.5, 0.5, 10)};
  const WardMerges merges(clusters, 6);
  EXPECT_EQ(merges.fewest(), 1u);
  EXPECT_EQ(merges.cut(4), (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(merges.cut(3), (std::vector<std::uint32_t>{0, 0, 1, 2}));
  EXPECT_EQ(merges.cut(2), (std::vector<std::uint32_t>{0, 0, 1, 1}));
  EXPECT_EQ(merges.cut(1), (std::vector<std::uint32_t>{0, 0, 0, 0}));
}

TEST(WardMerges, OfOneGroupAreThoseOfTheCheapestPairAgainAndAgain) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
    const std::vector<WardCluster> clusters = randomClusters(60, 30.0, seed);
    ASSERT_LE(clusters.size(), WardMerges::kMaxGroup);
    const WardMerges merges(clusters, 5);
    ASSERT_EQ(merges.fewest(), 1u);
    for (std::size_t count = 1; count <= clusters.size(); ++count)
      EXPECT_EQ(merges.cut(count), greedyCut(clusters, count)) << "seed " << seed << ", " << count << " clusters";
  }
}

TEST(WardMerges, OfManyGroupsLeaveAsManyClustersAsAskedForAndNestThem) {
  const std::vector<WardCluster> clusters = randomClusters(5000, 100.0, 7);
  const WardMerges merges(clusters, 7);
  EXPECT_GT(merges.fewest(), clusters.size() / WardMerges::kMaxGroup);
  EXPECT_LT(merges.fewest(), clusters.size() / 4);
  std::vector<std::uint32_t> finer = merges.cut(clusters.size());
  for (std::size_t count = clusters.size() - 500; count > merges.fewest(); count -= 500) {
    const std::vector<std::uint32_t> coarser = merges.cut(count);
    EXPECT_EQ(*std::max_element(coarser.begin(), coarser.end()) + 1, count);
    std::vector<std::uint32_t> whole(clusters.size(), 0xFFFFFFFFu);
    for (std::size_t i = 0; i < clusters.size(); ++i) {
      if (whole[finer[i]] == 0xFFFFFFFFu) whole[finer[i]] = coarser[i];
      ASSERT_EQ(whole[finer[i]], coarser[i]);  // no union is taken apart
    }
    finer = coarser;
    if (count < 500) break;
  }
  const std::vector<std::uint32_t> fewest = merges.cut(1);
  EXPECT_EQ(*std::max_element(fewest.begin(), fewest.end()) + 1, merges.fewest());
}

TEST(WardMerges, TakeEqualPlacesAndOneCluster) {
  EXPECT_TRUE(WardMerges({}, 4).cut(1).empty());
  EXPECT_EQ(WardMerges({clusterAt(1, 2, 3, 4)}, 4).cut(1), std::vector<std::uint32_t>{0});
  std::vector<WardCluster> lattice;  // many equal costs
  for (int i = 0; i < 64; ++i) {
    lattice.push_back(clusterAt(i % 4 + 0.5, i / 4 % 4 + 0.5, i / 16 + 0.5, 1));
    lattice.back().code = std::uint64_t(i);
  }
  const std::vector<std::uint32_t> halves = WardMerges(lattice, 2).cut(32);
  EXPECT_EQ(*std::max_element(halves.begin(), halves.end()), 31u);
}

}  // namespace
}  // namespace gaussmap::detail
