// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/clustering/agglomerate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "clustering/random_gaussians.h"

namespace gaussmap {
namespace {

constexpr MergeCost kCosts[] = {MergeCost::Volume, MergeCost::Runnalls, MergeCost::KL};

AgglomerateOptions with(MergeCost cost) {
  AgglomerateOptions options;
  options.cost = cost;
  return options;
}

std::vector<double> randomAreas(Random& random, std::size_t n) {
  std::vector<double> areas(n);
  for (double& area : areas) area = static_cast<double>(1 + random.below(20));
  return areas;
}

std::vector<double> ones(std::size_t n) {
  return std::vector<double>(n, 1.0);
}

template <int D>
Gaussian<D> sphere(double x, double sigma, double weight = 1.0) {
  return {Vector<D>::Unit(0) * x, sigma * sigma * Matrix<D>::Identity(), weight};
}

/// The definition: all pairs looked at before every merge, moments by merge(), determinants by Eigen.
template <int D>
Dendrogram bruteForce(const std::vector<Gaussian<D>>& data, const std::vector<double>& areas, MergeCost cost) {
  struct Cluster {
    Gaussian<D> gaussian;  // weight: of the moment match
    std::uint32_t node;
  };
  const auto costOf = [&](const Gaussian<D>& a, const Gaussian<D>& b) {
    if (cost == MergeCost::KL) return std::min(klDivergence(a, b), klDivergence(b, a));
    const Gaussian<D> both = merge<D>({a, b});
    if (cost == MergeCost::Runnalls)
      return 0.5 * (both.weight * logDeterminant<D>(both.cov) - a.weight * logDeterminant<D>(a.cov) -
                    b.weight * logDeterminant<D>(b.cov));
    const auto volume = [](const Gaussian<D>& g) { return std::exp(0.5 * logDeterminant<D>(g.cov)); };
    const double growth = volume(both) - volume(a) - volume(b);
    return cost == MergeCost::Volume ? growth : growth * std::sqrt(both.weight);
  };
  std::vector<Cluster> clusters;
  for (std::size_t j = 0; j < data.size(); ++j) {
    clusters.push_back({data[j], static_cast<std::uint32_t>(j)});
    if (cost == MergeCost::Volume) clusters.back().gaussian.weight = areas[j];
  }
  Dendrogram dendrogram{data.size(), {}};
  while (clusters.size() > 1) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t first = 0, second = 0;
    for (std::size_t i = 0; i < clusters.size(); ++i)
      for (std::size_t j = i + 1; j < clusters.size(); ++j)
        if (const double value = costOf(clusters[i].gaussian, clusters[j].gaussian); value < least) {
          least = value;
          first = i;
          second = j;
        }
    dendrogram.merges.push_back({clusters[first].node, clusters[second].node, least});
    clusters[first] = {merge<D>({clusters[first].gaussian, clusters[second].gaussian}),
                       static_cast<std::uint32_t>(data.size() + dendrogram.merges.size() - 1)};
    clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(second));
  }
  return dendrogram;
}

void expectSameTree(const Dendrogram& a, const Dendrogram& b, double tolerance) {
  ASSERT_EQ(a.size, b.size);
  ASSERT_EQ(a.merges.size(), b.merges.size());
  for (std::size_t t = 0; t < a.merges.size(); ++t) {
    ASSERT_EQ(a.merges[t].first, b.merges[t].first) << "merge " << t;
    ASSERT_EQ(a.merges[t].second, b.merges[t].second) << "merge " << t;
    ASSERT_NEAR(a.merges[t].cost, b.merges[t].cost, tolerance * (1.0 + std::abs(b.merges[t].cost))) << "merge " << t;
  }
}

template <int D>
void expectBruteForce(std::uint64_t seed) {
  Random random(seed);
  for (const MergeCost cost : kCosts) {
    for (int trial = 0; trial < 60; ++trial) {
      const std::vector<Gaussian<D>> data = randomGaussians<D>(random, random.below(41));
      const std::vector<double> areas = randomAreas(random, data.size());
      expectSameTree(agglomerate(data, areas, with(cost)), bruteForce<D>(data, areas, cost), 1e-9);
    }
  }
}

TEST(Agglomerate, MergesAsBruteForceDoes) {
  expectBruteForce<3>(1);
}
TEST(Agglomerate, MergesAsBruteForceDoesInThePlane) {
  expectBruteForce<2>(2);
}

TEST(Agglomerate, CostsWhatIsKnownOnPaper) {
  // Unit spheres at -1 and 1: variance 1 + 1 along x. sqrt(2) - 2; 2 ln 2 / 2.
  const auto costOf = [](MergeCost cost) {
    return agglomerate<3>({sphere<3>(-1, 1), sphere<3>(1, 1)}, ones(2), with(cost)).merges.at(0).cost;
  };
  EXPECT_NEAR(costOf(MergeCost::Volume), std::sqrt(2.0) - 2.0, 1e-14);
  EXPECT_NEAR(costOf(MergeCost::Runnalls), std::log(2.0), 1e-14);
  EXPECT_NEAR(costOf(MergeCost::KL), 2.0, 1e-14);  // 2^2 / 2
  // Spheres of sigma 1 and 2 at one place. From the small one to the large one: (3 ln 4 + 3 / 4 - 3) / 2. The other
  // direction, (-3 ln 4 + 12 - 3) / 2, is larger.
  for (const bool is_small_first : {true, false})
    EXPECT_NEAR(agglomerate<3>({sphere<3>(0, is_small_first ? 1 : 2), sphere<3>(0, is_small_first ? 2 : 1)}, ones(2),
                               with(MergeCost::KL))
                    .merges[0]
                    .cost,
                1.5 * std::log(4.0) - 1.125, 1e-14);
  // Areas 1 and 3: mean 0.5, variance along x 1 + 1 * 3 / 16 * 4. The weights, 5 and 15, matter to Runnalls alone.
  const std::vector<Gaussian<2>> uneven = {sphere<2>(-1, 1, 5), sphere<2>(1, 1, 15)};
  EXPECT_NEAR(agglomerate<2>(uneven, {1, 3}).merges[0].cost, std::sqrt(1.75) - 2.0, 1e-14);
  EXPECT_NEAR(agglomerate<2>(uneven, {1, 1}, with(MergeCost::Runnalls)).merges[0].cost, 10.0 * std::log(1.75), 1e-13);
}

TEST(Agglomerate, WeighsUnionsByWeightsForTheDivergence) {
  // The union of the first two has its mean at 0.9 (weights 1 : 9) and variance 1 + 0.09 * 1.
  const std::vector<Gaussian<2>> row = {sphere<2>(0, 1, 1), sphere<2>(1, 1, 9), sphere<2>(5, 1, 1)};
  const Dendrogram dendrogram = agglomerate<2>(row, {1, 1, 1}, with(MergeCost::KL));
  EXPECT_NEAR(dendrogram.merges[0].cost, 0.5, 1e-14);
  Gaussian<2> both = merge<2>({row[0], row[1]});
  EXPECT_NEAR(both.mean.x(), 0.9, 1e-15);
  EXPECT_NEAR(dendrogram.merges[1].cost, std::min(klDivergence(both, row[2]), klDivergence(row[2], both)), 1e-13);
}

TEST(Agglomerate, FollowsTheDivergenceForFlatAndThinGaussians) {  // condition numbers up to 4e8
  Random random(12);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Gaussian<3>> data = randomGaussians<3>(random, 12);
    for (Gaussian<3>& gaussian : data) {
      const Matrix<3> axes = Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
                                 .normalized()
                                 .toRotationMatrix();
      const Vector<3> deviations(10.0, trial % 2 == 0 ? 10.0 : 0.005, 0.005);
      gaussian.cov = axes * deviations.cwiseAbs2().asDiagonal() * axes.transpose() + 1e-4 * Matrix<3>::Identity();
    }
    expectSameTree(agglomerate(data, ones(12), with(MergeCost::KL)), bruteForce<3>(data, ones(12), MergeCost::KL),
                   1e-8);
  }
}

TEST(Agglomerate, TakesLogarithmsOverTheWholeRangeOfSizes) {
  for (double sigma = 1e-30; sigma < 1e31; sigma *= 7.3) {
    const double cost =
        agglomerate<3>({sphere<3>(0, sigma), sphere<3>(0, 2 * sigma)}, ones(2), with(MergeCost::Runnalls))
            .merges[0]
            .cost;
    // det of the union 2.5^3 sigma^6, of the parts sigma^6 and 4^3 sigma^6.
    EXPECT_NEAR(cost, 3.0 * std::log(2.5) - 1.5 * std::log(4.0), 1e-12) << sigma;
  }
}

TEST(Agglomerate, HandlesNoneOneAndTwo) {
  for (const MergeCost cost : kCosts) {
    const Dendrogram none = agglomerate<3>({}, {}, with(cost));
    EXPECT_EQ(none.size, 0u);
    EXPECT_TRUE(none.merges.empty());
    EXPECT_TRUE(labels(none, 1).empty());
    const Dendrogram one = agglomerate<3>({sphere<3>(1, 1)}, {1}, with(cost));
    EXPECT_TRUE(one.merges.empty());
    EXPECT_EQ(labels(one, 1), std::vector<int>{0});
    const Dendrogram two = agglomerate<3>({sphere<3>(1, 1), sphere<3>(9, 1)}, {1, 1}, with(cost));
    ASSERT_EQ(two.merges.size(), 1u);
    EXPECT_EQ(labels(two, 1), (std::vector<int>{0, 0}));
    EXPECT_EQ(labels(two, 2), (std::vector<int>{0, 1}));
  }
}

TEST(Agglomerate, MergesEveryNodeOnceAndKeepsTheSmallestFirst) {
  Random random(3);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 200);
  const Dendrogram dendrogram = agglomerate(data, randomAreas(random, 200));
  ASSERT_EQ(dendrogram.merges.size(), 199u);
  std::vector<std::uint32_t> smallest(399);
  std::iota(smallest.begin(), smallest.end(), 0u);
  std::set<std::uint32_t> used;
  for (std::size_t t = 0; t < 199; ++t) {
    const Dendrogram::Merge& merge = dendrogram.merges[t];
    EXPECT_LT(std::max(merge.first, merge.second), 200 + t);
    EXPECT_TRUE(used.insert(merge.first).second);
    EXPECT_TRUE(used.insert(merge.second).second);
    EXPECT_LT(smallest[merge.first], smallest[merge.second]);
    smallest[200 + t] = smallest[merge.first];
  }
}

TEST(Labels, AreNestedPartitionsInTheOrderOfTheirSmallestData) {
  Random random(4);
  const Dendrogram dendrogram = agglomerate(randomGaussians<2>(random, 60), ones(60));
  std::vector<int> coarser = labels(dendrogram, 1);
  for (std::size_t k = 1; k <= 60; ++k) {
    const std::vector<int> finer = labels(dendrogram, k);
    ASSERT_EQ(finer.size(), 60u);
    int next = 0;
    std::vector<int> parent(k, -1);
    for (std::size_t j = 0; j < 60; ++j) {
      ASSERT_LE(finer[j], next);  // a new label is the next one
      next = std::max(next, finer[j] + 1);
      int& up = parent[static_cast<std::size_t>(finer[j])];
      if (up < 0) up = coarser[j];
      ASSERT_EQ(up, coarser[j]);
    }
    ASSERT_EQ(next, static_cast<int>(k));
    coarser = finer;
  }
}

TEST(Labels, RefuseANumberOfPartsThatIsNotThere) {
  const Dendrogram dendrogram = agglomerate<3>({sphere<3>(0, 1), sphere<3>(1, 1)}, ones(2));
  EXPECT_THROW(labels(dendrogram, 0), std::invalid_argument);
  EXPECT_THROW(labels(dendrogram, 3), std::invalid_argument);
}

TEST(Agglomerate, GivesTheSamePartsForAnyOrderOfTheData) {
  Random random(5);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 150);
  const std::vector<double> areas = randomAreas(random, 150);
  for (const MergeCost cost : kCosts) {
    const Dendrogram dendrogram = agglomerate(data, areas, with(cost));
    for (int trial = 0; trial < 5; ++trial) {
      std::vector<std::size_t> order(150);
      std::iota(order.begin(), order.end(), std::size_t{0});
      for (std::size_t i = 149; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
      std::vector<Gaussian<3>> shuffled;
      std::vector<double> shuffled_areas;
      for (const std::size_t j : order) {
        shuffled.push_back(data[j]);
        shuffled_areas.push_back(areas[j]);
      }
      const Dendrogram other = agglomerate(shuffled, shuffled_areas, with(cost));
      for (std::size_t t = 0; t < 149; ++t) EXPECT_EQ(other.merges[t].cost, dendrogram.merges[t].cost);  // every bit
      for (const std::size_t k : {2u, 7u, 50u}) {
        const std::vector<int> expected = labels(dendrogram, k), found = labels(other, k);
        std::set<std::pair<int, int>> pairs;
        for (std::size_t i = 0; i < 150; ++i) pairs.insert({expected[order[i]], found[i]});
        EXPECT_EQ(pairs.size(), k);
      }
    }
  }
}

TEST(Agglomerate, BreaksTiesTowardsTheSmallerIndices) {
  // Three in a row at equal distances, twice: 0 and 1 before 1 and 2 (who then joins them), here before there.
  std::vector<Gaussian<2>> data;
  for (const double x : {0.0, 8.0, 16.0, 1024.0, 1032.0, 1040.0}) data.push_back(sphere<2>(x, 1));
  const Dendrogram dendrogram = agglomerate(data, ones(6));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const Dendrogram::Merge& merge : dendrogram.merges) pairs.push_back({merge.first, merge.second});
  EXPECT_EQ(pairs, (decltype(pairs){{0, 1}, {6, 2}, {3, 4}, {8, 5}, {7, 9}}));
}

TEST(Agglomerate, MergesDuplicatesFirst) {
  Random random(6);
  const std::vector<Gaussian<3>> different = randomGaussians<3>(random, 12);
  std::vector<Gaussian<3>> data;
  for (int copy = 0; copy < 5; ++copy) data.insert(data.end(), different.begin(), different.end());
  for (std::size_t max_exact : {std::size_t{1000}, std::size_t{0}}) {
    AgglomerateOptions options = with(MergeCost::Runnalls);  // a cost that is 0 for duplicates, positive for all others
    options.max_exact = max_exact;
    options.restricted_until = 12;
    const std::vector<int> found = labels(agglomerate(data, ones(60), options), 12);
    for (std::size_t j = 0; j < 60; ++j) EXPECT_EQ(found[j], static_cast<int>(j % 12));
  }
  const std::vector<Gaussian<3>> same(50, different[0]);
  for (const MergeCost cost : kCosts) EXPECT_EQ(agglomerate(same, ones(50), with(cost)).merges.size(), 49u);
}

TEST(Agglomerate, IsTheSameFarAway) {
  Random random(7);
  std::vector<Gaussian<3>> data = randomGaussians<3>(random, 80);
  for (Gaussian<3>& gaussian : data)
    gaussian.mean = (gaussian.mean * 1024.0).array().round() / 1024.0;  // exact when moved
  const Dendrogram here = agglomerate(data, ones(80));
  for (Gaussian<3>& gaussian : data) gaussian.mean += Vector<3>(6e12, -4e12, 2e12);
  expectSameTree(agglomerate(data, ones(80)), here, 1e-9);
}

TEST(Agglomerate, EndsWithFiniteCostsOnDataOfAnySize) {
  Random random(8);
  for (const double scale : {1e-60, 1e-20, 1e20, 1e60, 1e120, 1e307}) {
    std::vector<Gaussian<3>> data = randomGaussians<3>(random, 30);
    for (Gaussian<3>& gaussian : data) gaussian.mean *= scale;
    for (const MergeCost cost : kCosts) {
      const Dendrogram dendrogram = agglomerate(data, ones(30), with(cost));
      ASSERT_EQ(dendrogram.merges.size(), 29u);
      for (const Dendrogram::Merge& merge : dendrogram.merges) EXPECT_TRUE(std::isfinite(merge.cost)) << scale;
    }
  }
}

TEST(Agglomerate, EndsWithFiniteCostsWhereDeterminantsOverflow) {
  std::vector<Gaussian<3>> data;
  for (int i = 0; i < 12; ++i) data.push_back(sphere<3>(1e51 * i, 5e51));  // det = 1e310
  for (const MergeCost cost : kCosts)
    for (const Dendrogram::Merge& merge : agglomerate(data, ones(12), with(cost)).merges)
      EXPECT_TRUE(std::isfinite(merge.cost));
}

TEST(Agglomerate, FindsTwoWallsAndAPole) {
  Random random(9);
  const std::vector<Gaussian<3>> patches = wallsAndPole(random);
  const std::vector<int> found = labels(agglomerate(patches, ones(patches.size())), 3);
  for (std::size_t j = 0; j < patches.size(); ++j) EXPECT_EQ(found[j], static_cast<int>(j / kPatches));
}

TEST(Agglomerate, NamesWhatItRefuses) {
  const auto messageFor = [](const std::vector<Gaussian<3>>& data, const std::vector<double>& areas) -> std::string {
    try {
      agglomerate(data, areas);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "accepted";
  };
  const Gaussian<3> good = sphere<3>(0, 1);
  Gaussian<3> bad = good;
  bad.weight = 0.0;
  EXPECT_NE(messageFor({good, bad}, {1, 1}).find("Gaussian 1: the weight must be"), std::string::npos);
  bad = good;
  bad.mean(2) = std::nan("");
  EXPECT_NE(messageFor({good, bad}, {1, 1}).find("Gaussian 1: the mean is not finite"), std::string::npos);
  bad = good;
  bad.cov(2, 2) = 0.0;
  EXPECT_NE(messageFor({bad, good}, {1, 1}).find("Gaussian 0: the covariance"), std::string::npos);
  EXPECT_THROW(agglomerate<3>({bad}, {1}), std::domain_error);
  for (const double area : {0.0, -1.0, HUGE_VAL, std::nan("")})
    EXPECT_NE(messageFor({good, good}, {1, area}).find("Gaussian 1: the area must be"), std::string::npos);
  EXPECT_NE(messageFor({good, good}, {1}).find("1 areas for 2 Gaussians"), std::string::npos);
  AgglomerateOptions options;
  options.neighbours = 0;
  EXPECT_THROW(agglomerate<3>({good}, {1}, options), std::invalid_argument);
  options = {};
  options.restricted_until = 0;
  EXPECT_THROW(agglomerate<3>({good}, {1}, options), std::invalid_argument);
}

TEST(Agglomerate, IsExactWhenEveryoneIsANeighbour) {
  Random random(10);
  for (const MergeCost cost : kCosts) {
    const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 120);
    const std::vector<double> areas = randomAreas(random, 120);
    AgglomerateOptions options = with(cost);
    const Dendrogram exact = agglomerate(data, areas, options);
    options.max_exact = 0;
    options.neighbours = 120;
    for (const std::size_t until : {1u, 30u, 200u}) {
      options.restricted_until = until;
      expectSameTree(agglomerate(data, areas, options), exact, 0.0);
    }
  }
}

TEST(Agglomerate, LosesLittleWithFewNeighbours) {
  // The volume that is left at k parts, restricted against exact.
  Random random(11);
  std::vector<Gaussian<3>> data = wallsAndPole(random);
  for (int copy = 0; copy < 7; ++copy) {
    const std::vector<Gaussian<3>> more = wallsAndPole(random);
    data.insert(data.end(), more.begin(), more.end());
  }
  for (Gaussian<3>& gaussian : data) gaussian.cov += 0.0025 * Matrix<3>::Identity();
  ASSERT_GT(data.size(), AgglomerateOptions().max_exact);
  const auto volumeAt = [&](std::size_t k, std::size_t max_exact) {
    AgglomerateOptions options;
    options.max_exact = max_exact;
    const std::vector<int> found = labels(agglomerate(data, ones(data.size()), options), k);
    std::vector<std::vector<Gaussian<3>>> parts(k);
    for (std::size_t j = 0; j < data.size(); ++j) {
      parts[static_cast<std::size_t>(found[j])].push_back(data[j]);
      parts[static_cast<std::size_t>(found[j])].back().weight = 1.0;
    }
    double volume = 0.0;
    for (const auto& part : parts) volume += std::exp(0.5 * logDeterminant<3>(merge(part).cov));
    return volume;
  };
  for (const std::size_t k : {3u, 10u, 30u, 100u}) EXPECT_NEAR(volumeAt(k, 1000) / volumeAt(k, 100000), 1.0, 0.05) << k;
}

}  // namespace
}  // namespace gaussmap
