// SPDX-License-Identifier: BSD-3-Clause
// mergeMaps() and simplify() as Yguel et al. 2009 print them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "editing/thinned_map.h"
#include "gaussmap/clustering/kl_kmeans.h"
#include "gaussmap/editing/compress.h"
#include "gaussmap/editing/merge_maps.h"
#include "gaussmap/editing/simplify.h"
#include "gaussmap/map/queries.h"
#include "io/gmap/map_equality.h"
#include "map/inherit_occupancy.h"
#include "mapping/map_checks.h"

namespace gaussmap::test {
using namespace detail;

namespace {

/// The words of the paper: replaces the pair of smallest divergence by its union, until k are left.
template <int D>
std::vector<Gaussian<D>> unionsByHand(std::vector<Gaussian<D>> clusters, std::size_t k) {
  while (clusters.size() > k) {
    std::size_t u_min = 0, v_min = 1;
    for (std::size_t u = 0; u < clusters.size(); ++u)
      for (std::size_t v = 0; v < clusters.size(); ++v)
        if (u != v && klDivergence(clusters[u], clusters[v]) < klDivergence(clusters[u_min], clusters[v_min]))
          u_min = u, v_min = v;
    const Gaussian<D> both = merge<D>({clusters[u_min], clusters[v_min]});
    clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(std::max(u_min, v_min)));
    clusters[std::min(u_min, v_min)] = both;
  }
  return clusters;
}

template <int D>
std::vector<Gaussian<D>> clustersIn(const GaussianMap<D>& map, const CellKey<D>& key, int s) {
  std::vector<Gaussian<D>> clusters;
  const auto cell = map.find(key, s);
  if (!cell) return clusters;
  const IndexRange range = map.gaussiansOf(*cell, s);
  for (std::size_t i = range.first; i < range.last; ++i) clusters.push_back(map.localGaussian(i, s));
  return clusters;
}

/// Returns true if the clusters are the same, in any order, up to rounding.
template <int D>
bool areSame(std::vector<Gaussian<D>> a, const std::vector<Gaussian<D>>& b) {
  if (a.size() != b.size()) return false;
  for (const Gaussian<D>& one : b) {
    const auto twin = std::find_if(a.begin(), a.end(), [&](const Gaussian<D>& other) {
      return (one.mean - other.mean).norm() < 1e-9 && (one.cov - other.cov).norm() < 1e-9 &&
             std::abs(one.weight - other.weight) < 1e-6;
    });
    if (twin == a.end()) return false;
    a.erase(twin);
  }
  return true;
}

/// A map of one scale. Cells `first` to `last` - 1 of a row hold `least` to `least` + 7 Gaussians of any shape.
template <int D>
GaussianMap<D> rowOfCells(std::uint64_t seed, int first, int last, std::size_t least = 1) {
  Random random(seed);
  MapScale<D> scale;
  scale.first_gaussian = {0};
  for (int x = first; x < last; ++x) {
    CellKey<D> key{};
    key[0] = x;
    scale.keys.push_back(key);
    for (std::size_t count = least + random.below(8); count > 0; --count) {
      Gaussian<D> gaussian;
      Matrix<D> factor;
      for (int axis = 0; axis < D; ++axis) {
        gaussian.mean(axis) = 0.08 * random.uniform() - 0.04;
        for (int column = 0; column < D; ++column) factor(axis, column) = 0.02 * random.normal();
      }
      gaussian.cov = factor * factor.transpose() + 1e-5 * Matrix<D>::Identity();
      gaussian.weight = 1.0 + static_cast<double>(random.below(50));
      scale.gaussians.push_back(gaussian);
    }
    scale.first_gaussian.push_back(static_cast<std::uint32_t>(scale.gaussians.size()));
  }
  return GaussianMap<D>(smallGrid<D>(4, 1), {scale});
}

struct CellCounts {
  std::size_t shared = 0, same = 0;
};

/// Counts the finest cells of both maps, and those whose clusters in the merged map are the expected ones.
template <int D>
CellCounts compareWithHand(const GaussianMap<D>& a, const GaussianMap<D>& b, const MergeMapsOptions& options,
                           bool smooth) {
  const GaussianMap<D> merged = mergeMaps<D>(a, b, options);
  CellCounts counts;
  for (const CellKey<D>& key : merged.scale(0).keys) {
    const std::vector<Gaussian<D>> of_a = clustersIn<D>(a, key, 0), of_b = clustersIn<D>(b, key, 0);
    std::vector<Gaussian<D>> all = of_a;
    all.insert(all.end(), of_b.begin(), of_b.end());
    if (of_a.empty() || of_b.empty()) {
      EXPECT_TRUE(areSame(clustersIn<D>(merged, key, 0), all));
      continue;
    }
    const std::size_t k = std::max(of_a.size(), of_b.size());
    if (k == 1) continue;  // nothing to choose
    std::vector<Gaussian<D>> expected = unionsByHand(all, k);
    if (smooth) expected = KLKMeans<D>().run(all, expected).centres;
    ++counts.shared;
    counts.same += areSame(clustersIn<D>(merged, key, 0), expected);
  }
  return counts;
}

template <int D>
void expectMergesByHand() {
  const GaussianMap<D> a = rowOfCells<D>(1, 0, 100), b = rowOfCells<D>(2, 10, 110);
  const MergeMapsOptions paper = MergeMapsOptions::yguel2009();
  CellCounts counts = compareWithHand(a, b, paper, true);
  EXPECT_GT(counts.shared, 50u);
  EXPECT_EQ(counts.same, counts.shared);
  MergeMapsOptions other = paper;
  other.smooth = false;
  counts = compareWithHand(a, b, other, false);
  EXPECT_EQ(counts.same, counts.shared);
  counts = compareWithHand(a, b, other, true);
  EXPECT_LT(counts.same, counts.shared);  // the run of the clustering changes cells
  other = paper;
  other.merge_cost = MergeCost::Volume;
  counts = compareWithHand(a, b, other, true);
  EXPECT_LT(counts.same, counts.shared);
}

TEST(MergeClusters, MergesThePairsOfSmallestDivergenceAndRunsTheClusteringOnce) {
  expectMergesByHand<2>();
  expectMergesByHand<3>();
}

/// Returns the number of cells of coarse scales that both maps have, and of those with more clusters than each had.
template <int D>
std::pair<std::size_t, std::size_t> cellsWithMore(const GaussianMap<D>& a, const GaussianMap<D>& b,
                                                  const GaussianMap<D>& merged) {
  std::size_t shared = 0, more = 0;
  for (int s = 1; s < merged.scales(); ++s)
    for (const CellKey<D>& key : merged.scale(s).keys) {
      const std::size_t p = clustersIn<D>(a, key, s).size(), q = clustersIn<D>(b, key, s).size();
      if (p == 0 || q == 0) continue;
      ++shared;
      more += clustersIn<D>(merged, key, s).size() > std::max(p, q);
    }
  return {shared, more};
}

TEST(MergeClusters, FixesTheNumberOfClustersPerCell) {
  const GaussianMap<3> a = refinedMap<3>(randomCloud<3>(8000, 6), smallGrid<3>()),
                       b = refinedMap<3>(randomCloud<3>(8000, 7), smallGrid<3>());
  const MergeMapsOptions paper = MergeMapsOptions::yguel2009();
  const auto [shared, more] = cellsWithMore(a, b, mergeMaps<3>(a, b, paper));
  EXPECT_GT(shared, 20u);
  EXPECT_EQ(more, 0u);
  MergeMapsOptions other = paper;
  other.smooth = false;  // the run can drop clusters
  const GaussianMap<3> unsmoothed = mergeMaps<3>(a, b, other);
  for (int s = 1; s < 3; ++s) {
    std::size_t expected = 0;
    for (const CellKey<3>& key : unsmoothed.scale(s).keys)
      expected += std::max(clustersIn<3>(a, key, s).size(), clustersIn<3>(b, key, s).size());
    EXPECT_EQ(unsmoothed.gaussianCount(s), expected);
  }
  other = paper;
  other.method = MergeMethod::FinerScales;
  EXPECT_GT(cellsWithMore(a, b, mergeMaps<3>(a, b, other)).second, 0u);
}

TEST(MergeClusters, KeepsWeightsLinksAndTheExactFinestScale) {
  const std::vector<Vector<3>> points = randomCloud<3>(16000, 6);
  const std::vector<Vector<3>> half(points.begin(), points.begin() + 8000), rest(points.begin() + 8000, points.end());
  const MapOptions grid = smallGrid<3>();
  const GaussianMap<3> a = refinedMap<3>(half, grid), b = refinedMap<3>(rest, grid);
  const GaussianMap<3> merged = mergeMaps<3>(a, b, MergeMapsOptions::yguel2009());
  EXPECT_TRUE(sameFinest<3>(merged, build<3>(points, grid)));
  EXPECT_TRUE(merged.acceptsScans());
  for (int s = 0; s < 3; ++s) {
    EXPECT_NEAR(merged.weight(s), 16000.0, 1e-6);
    expectSameMatch<3>(matchOfScale<3>(merged, s), matchOfScale<3>(merged, 0));
  }
  expectSameMap<3>(mergeMaps<3>(b, a, MergeMapsOptions::yguel2009()), merged);
}

TEST(MergeClusters, GivesTheChildrenOfMergedClustersToTheUnion) {
  // Finest cells of 0.1 m under one cell of 0.8 m. Map a has a cluster on the left and one on the right, b only one on
  // the right. Two are left, and the one on the right has the children of both maps.
  const MapOptions grid = smallGrid<2>(8, 2);
  const GaussianMap<2> a = refinedMap<2>({{0.05, 0.05}, {0.65, 0.05}}, grid), b = build<2>({{0.75, 0.05}}, grid);
  ASSERT_EQ(a.gaussianCount(1), 2u);
  const GaussianMap<2> merged = mergeMaps<2>(a, b, MergeMapsOptions::yguel2009());
  ASSERT_EQ(merged.gaussianCount(0), 3u);
  ASSERT_EQ(merged.gaussianCount(1), 2u);
  EXPECT_NE(merged.parentOf(0, 0), merged.parentOf(1, 0));
  EXPECT_EQ(merged.parentOf(1, 0), merged.parentOf(2, 0));
  const Gaussian<2> right = merged.gaussian(merged.parentOf(2, 0), 1);
  EXPECT_EQ(right.weight, 2.0);
  EXPECT_NEAR(right.mean.x(), 0.7, 1e-12);
  EXPECT_NEAR(right.cov(0, 0), 0.05 * 0.05 + 0.005 * 0.005, 1e-12);  // spread of the means, and the noise floor
}

TEST(MergeClusters, KeepsUnionsThatLoseTheirChildren) {
  std::vector<Vector<3>> points = randomCloud<3>(8000, 6);
  const std::vector<Vector<3>> more = randomCloud<3>(8000, 7);
  const GaussianMap<3> p = refinedMap<3>(points, smallGrid<3>()), q = refinedMap<3>(more, smallGrid<3>()),
                       both = mergeMaps<3>(p, q, MergeMapsOptions::yguel2009());
  std::size_t without = 0;
  for (std::size_t i = 0; i < both.gaussianCount(1); ++i) without += both.childrenOf(i, 1).empty();
  ASSERT_GT(without, 0u);
  for (const MergeCost cost : {MergeCost::Volume, MergeCost::KL}) {
    const GaussianMap<3> simple = simplify<3>(both, PerCell{1.5}, {cost}).map;
    expectMomentMatches<3>(simple);
    for (int s = 0; s < 3; ++s) EXPECT_NEAR(simple.weight(s), 16000.0, 1e-6);
  }
  points.insert(points.end(), more.begin(), more.end());
  expectSameMap<3>(refine<3>(both).map, refinedMap<3>(points, smallGrid<3>()));
}

double leafWeight(const GaussianMap<3>& map) {
  double weight = 0.0;
  for (const GaussianId& leaf : leaves(map)) weight += map.gaussian(leaf.index, leaf.scale).weight;
  return weight;
}

TEST(MergeClusters, MergesCompressedMapsWithoutFinerScales) {
  const GaussianMap<3> a = refinedMap<3>(randomCloud<3>(8000, 6), smallGrid<3>()),
                       b = refinedMap<3>(randomCloud<3>(8000, 7), smallGrid<3>()), small = thinned<3>(a);
  ASSERT_TRUE(small.isCompressed());
  for (const auto& [p, q] : {std::pair(small, b), std::pair(b, small), std::pair(small, thinned<3>(b))}) {
    const GaussianMap<3> merged = mergeMaps<3>(p, q, MergeMapsOptions::yguel2009());
    EXPECT_TRUE(merged.isCompressed());
    EXPECT_NEAR(merged.weight(2), 16000.0, 1e-6);
    EXPECT_NEAR(leafWeight(merged), 16000.0, 1e-6);
    expectSameMatch<3>(matchOfScale<3>(merged, 2), merge<3>({matchOfScale<3>(p, 2), matchOfScale<3>(q, 2)}));
    for (int s = 1; s < 3; ++s)  // a leaf of one map is a leaf of the result
      for (std::size_t cell = 0; cell < merged.cellCount(s); ++cell) {
        const CellKey<3>& key = merged.scale(s).keys[cell];
        const auto in_p = p.find(key, s), in_q = q.find(key, s);
        EXPECT_EQ(merged.isLeaf(cell, s), (in_p && p.isLeaf(*in_p, s)) || (in_q && q.isLeaf(*in_q, s)));
      }
  }
  EXPECT_THROW(mergeMaps<3>(small, b), std::invalid_argument);
}

TEST(MergeClusters, AddsLogOddsAtEveryScale) {
  const auto oneCell = [](std::optional<float> log_odds) {
    const GaussianMap<2> map = build<2>({{0.05, 0.05}}, smallGrid<2>());
    return log_odds ? withOccupancy<2>(map, {*log_odds}) : map;
  };
  CompressOptions by_error = CompressOptions::yguel2009();
  for (const bool is_compressed : {false, true}) {
    const auto merged = [&](std::optional<float> p, std::optional<float> q) {
      GaussianMap<2> a = oneCell(p), b = oneCell(q);
      if (is_compressed) a = compress<2>(a, 1.0, by_error), b = compress<2>(b, 1.0, by_error);
      return mergeMaps<2>(a, b, MergeMapsOptions::yguel2009());
    };
    EXPECT_EQ(merged(1.5f, 2.0f).logOdds(0, 2), 3.5f);
    EXPECT_EQ(merged(8.0f, 7.0f).logOdds(0, 2), kMaxOccupancy);
    EXPECT_EQ(merged(-2.0f, std::nullopt).logOdds(0, 2), -2.0f);
    EXPECT_EQ(merged(1.5f, 2.0f).cellCount(0), is_compressed ? 0u : 1u);
  }
}

TEST(MergeClusters, IsTheSameForAnyNumberOfThreads) {
  const GaussianMap<3> a = refinedMap<3>(randomCloud<3>(8000, 6), smallGrid<3>()),
                       b = refinedMap<3>(randomCloud<3>(8000, 7), smallGrid<3>());
  MergeMapsOptions one = MergeMapsOptions::yguel2009(), two = one;
  one.threads = 1;
  two.threads = 2;
  expectSameMap<3>(mergeMaps<3>(a, b, one), mergeMaps<3>(a, b, two));
}

TEST(MergeClusters, HasTheEmptyMapAsNeutralElement) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(3000, 1), smallGrid<3>()), empty(smallGrid<3>());
  expectSameMap<3>(mergeMaps<3>(map, empty, MergeMapsOptions::yguel2009()), map);
  expectSameMap<3>(mergeMaps<3>(empty, map, MergeMapsOptions::yguel2009()), map);
}

// ---- simplify -------------------------------------------------------------------------------------------------------

/// Returns the number of maps, of 10, that simplify() reduces to 6 clusters as the paper says.
int simplifiedByHand(const SimplifyOptions& options, bool smooth) {
  int same = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const GaussianMap<2> map = rowOfCells<2>(seed, 0, 1, 15);
    const CellKey<2> key = map.scale(0).keys.front();
    const std::vector<Gaussian<2>> all = clustersIn<2>(map, key, 0);
    std::vector<Gaussian<2>> expected = unionsByHand(all, 6);
    if (smooth) expected = KLKMeans<2>().run(all, expected).centres;
    const GaussianMap<2> simple = simplify<2>(map, MaxGaussians{{{0, 6}}}, options).map;
    same += areSame(clustersIn<2>(simple, key, 0), expected);
  }
  return same;
}

TEST(SimplifyClusters, MergesThePairsOfSmallestDivergenceAndRunsTheClusteringOnce) {
  const SimplifyOptions paper = SimplifyOptions::yguel2009();
  EXPECT_EQ(simplifiedByHand(paper, true), 10);
  SimplifyOptions other = paper;
  other.smooth = false;
  EXPECT_EQ(simplifiedByHand(other, false), 10);
  EXPECT_LT(simplifiedByHand(other, true), 10);
  other = paper;
  other.merge_cost = MergeCost::Volume;
  EXPECT_LT(simplifiedByHand(other, true), 10);
}

TEST(SimplifyClusters, OfThePaperKeepsTheBudgetAndTheLinks) {
  const GaussianMap<3> map = refinedMap<3>(randomCloud<3>(9000, 1), smallGrid<3>());
  for (const GaussianMap<3>& one : {map, thinned<3>(map)}) {
    const GaussianMap<3> simple = simplify<3>(one, PerCell{1.7}, SimplifyOptions::yguel2009()).map;
    for (int s = 1; s < 3; ++s) {
      EXPECT_LE(simple.gaussianCount(s), static_cast<std::size_t>(1.7 * double(one.cellCount(s))));
      EXPECT_GE(simple.gaussianCount(s), static_cast<std::size_t>(1.5 * double(one.cellCount(s))));
      EXPECT_NEAR(simple.weight(s), one.weight(s), 1e-6);
    }
    expectMomentMatches<3>(simple);
  }
}

}  // namespace
}  // namespace gaussmap::test
