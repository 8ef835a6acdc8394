// SPDX-License-Identifier: BSD-3-Clause
#include "clustering/merge_neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "clustering/random_gaussians.h"

namespace gaussmap {
using namespace detail;

namespace {

using Pairs = std::set<std::pair<std::size_t, std::size_t>>;  // first < second

Pairs::value_type ordered(std::size_t i, std::size_t j) {
  return {std::min(i, j), std::max(i, j)};
}

/// Pairs of slots of which one is among the nearest of the other, from all distances.
template <int D>
Pairs nearestPairs(const MergeTable<D>& table, const std::vector<std::size_t>& live, std::size_t neighbours) {
  Pairs pairs;
  for (const std::size_t i : live) {
    std::vector<std::pair<double, std::size_t>> others;
    for (const std::size_t j : live) {
      double squared = 0.0;
      for (int axis = 0; axis < D; ++axis) squared += std::pow(table.mean(i, axis) - table.mean(j, axis), 2);
      if (j != i) others.push_back({squared, j});
    }
    std::sort(others.begin(), others.end());
    for (std::size_t rank = 0; rank < std::min(neighbours, others.size()); ++rank)
      pairs.insert(ordered(i, others[rank].second));
  }
  return pairs;
}

/// The definition: all candidates looked at before every merge. Costs from a table, so that ties are ties.
template <int D>
Dendrogram bruteForce(MergeHistory<D>&& history, std::size_t neighbours, std::size_t until) {
  std::vector<std::size_t> live(history.node.size());
  for (std::size_t slot = 0; slot < live.size(); ++slot) live[slot] = slot;
  while (live.size() > until) {
    Pairs pairs = nearestPairs(history.table, live, neighbours);
    const std::size_t round = std::max(until, live.size() / 2);
    while (live.size() > round && !pairs.empty()) {
      auto [a, b] = *pairs.begin();
      for (const auto& [i, j] : pairs)  // in order: the first of equal ones stays
        if (history.table.cost(i, j) < history.table.cost(a, b)) std::tie(a, b) = std::make_pair(i, j);
      history.merge(a, b, history.table.cost(a, b));
      live.erase(std::find(live.begin(), live.end(), b));
      Pairs inherited;
      for (auto [i, j] : pairs) {
        if (i == b) i = a;
        if (j == b) j = a;
        if (i != j) inherited.insert(ordered(i, j));
      }
      pairs = inherited;
    }
  }
  return history.dendrogram;
}

void expectSame(const Dendrogram& a, const Dendrogram& b) {
  ASSERT_EQ(a.merges.size(), b.merges.size());
  for (std::size_t t = 0; t < a.merges.size(); ++t) {
    ASSERT_EQ(a.merges[t].first, b.merges[t].first) << "merge " << t;
    ASSERT_EQ(a.merges[t].second, b.merges[t].second) << "merge " << t;
    ASSERT_EQ(a.merges[t].cost, b.merges[t].cost) << "merge " << t;
  }
}

template <int D>
void expectBruteForce(MergeCost cost) {
  Random random(1);
  for (const std::size_t neighbours : {1u, 2u, 5u}) {
    for (const std::size_t until : {1u, 10u, 40u}) {
      const std::vector<Gaussian<D>> data = randomGaussians<D>(random, 60);
      const std::vector<double> areas(60, 2.0);
      const Dendrogram expected = bruteForce(MergeHistory<D>(data, areas, cost), neighbours, until);
      MergeHistory<D> history(data, areas, cost);
      mergeNeighbours(history, neighbours, until);
      EXPECT_EQ(history.table.slots(), until);
      expectSame(history.dendrogram, expected);
    }
  }
}

TEST(MergeNeighbours, MergesAsBruteForceDoes) {
  for (const MergeCost cost : {MergeCost::Volume, MergeCost::Runnalls}) {
    expectBruteForce<2>(cost);
    expectBruteForce<3>(cost);
  }
}

TEST(Agglomerate, BreaksTiesAsBruteForceDoes) {  // a lattice of equal Gaussians: nearly all costs are ties
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Gaussian<2>> data(2 + random.below(39), {{0, 0}, Eigen::Matrix2d::Identity(), 1.0});
    for (Gaussian<2>& gaussian : data)
      gaussian.mean = {4.0 * static_cast<double>(random.below(4)), 4.0 * static_cast<double>(random.below(4))};
    const std::vector<double> areas(data.size(), 1.0);
    for (const MergeCost cost : {MergeCost::Volume, MergeCost::Runnalls}) {
      AgglomerateOptions options;
      options.cost = cost;
      // All clusters are neighbours, also after each new search, so every pair is always a candidate.
      const Dendrogram expected = bruteForce(MergeHistory<2>(data, areas, cost), data.size(), 1);
      expectSame(agglomerate(data, areas, options), expected);
      options.max_exact = 0;
      options.neighbours = data.size();
      options.restricted_until = 1;
      expectSame(agglomerate(data, areas, options), expected);
    }
  }
}

}  // namespace
}  // namespace gaussmap
