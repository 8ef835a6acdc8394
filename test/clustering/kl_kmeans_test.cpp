// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/clustering/kl_kmeans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "clustering/random_gaussians.h"

namespace gaussmap {
namespace {

template <int D>
std::vector<int> naiveLabels(const std::vector<Gaussian<D>>& data, const std::vector<Gaussian<D>>& centres) {
  std::vector<int> labels;
  for (const Gaussian<D>& z : data) {
    int best = 0;
    for (int c = 1; c < static_cast<int>(centres.size()); ++c)
      if (klDivergence(z, centres[std::size_t(c)]) < klDivergence(z, centres[std::size_t(best)])) best = c;
    labels.push_back(best);
  }
  return labels;
}

/// What every result promises, by the formulas of the paper.
template <int D>
void expectSound(const std::vector<Gaussian<D>>& data, const KLClustering<D>& clustering) {
  ASSERT_EQ(clustering.labels.size(), data.size());
  double distortion = 0.0;
  std::vector<std::vector<Gaussian<D>>> members(clustering.centres.size());
  for (std::size_t j = 0; j < data.size(); ++j) {
    ASSERT_GE(clustering.labels[j], 0);
    ASSERT_LT(clustering.labels[j], static_cast<int>(clustering.centres.size()));
    const auto label = static_cast<std::size_t>(clustering.labels[j]);
    members[label].push_back(data[j]);
    distortion += data[j].weight * klDivergence(data[j], clustering.centres[label]);  // eq. (7)
  }
  EXPECT_NEAR(clustering.distortion, distortion, 1e-9 * (1.0 + distortion));
  for (std::size_t c = 0; c < members.size(); ++c) {
    ASSERT_FALSE(members[c].empty());
    const Gaussian<D> match = merge(members[c]);
    EXPECT_EQ(clustering.centres[c].mean, match.mean);
    EXPECT_EQ(clustering.centres[c].cov, match.cov);
    EXPECT_EQ(clustering.centres[c].weight, match.weight);
  }
}

KLKMeansOptions withK(int k) {
  KLKMeansOptions options;
  options.k = k;
  return options;
}

TEST(KLKMeans, NamesTheOptionThatItRefuses) {
  const auto messageFor = [](void (*spoil)(KLKMeansOptions&)) -> std::string {
    KLKMeansOptions options;
    spoil(options);
    try {
      KLKMeans<3> kmeans(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_NE(messageFor([](KLKMeansOptions& o) { o.k = 0; }).find("k = 0"), std::string::npos);
  EXPECT_NE(messageFor([](KLKMeansOptions& o) { o.max_iterations = 0; }).find("max_iterations"), std::string::npos);
  EXPECT_NE(messageFor([](KLKMeansOptions& o) { o.tolerance = -1e-3; }).find("tolerance"), std::string::npos);
  EXPECT_NE(messageFor([](KLKMeansOptions& o) { o.tolerance = std::nan(""); }).find("tolerance"), std::string::npos);
  EXPECT_NE(messageFor([](KLKMeansOptions& o) { o.max_swaps = -1; }).find("max_swaps"), std::string::npos);
}

TEST(KLKMeans, NamesTheGaussianThatItRefuses) {
  Random random(1);
  const std::vector<Gaussian<3>> good = randomGaussians<3>(random, 5);
  const auto messageFor = [&](void (*spoil)(Gaussian<3>&)) -> std::string {
    std::vector<Gaussian<3>> data = good;
    spoil(data[3]);
    try {
      KLKMeans<3>(withK(2)).fit(data);
    } catch (const std::invalid_argument& error) {
      return std::string("argument: ") + error.what();
    } catch (const std::domain_error& error) {
      return std::string("domain: ") + error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(messageFor([](Gaussian<3>& z) { z.weight = 0.0; }).find("argument: Gaussian 3"), 0u);
  EXPECT_EQ(messageFor([](Gaussian<3>& z) { z.weight = -1.0; }).find("argument: Gaussian 3"), 0u);
  EXPECT_EQ(messageFor([](Gaussian<3>& z) { z.weight = std::nan(""); }).find("argument: Gaussian 3"), 0u);
  EXPECT_EQ(messageFor([](Gaussian<3>& z) { z.weight = HUGE_VAL; }).find("argument: Gaussian 3"), 0u);
  EXPECT_EQ(messageFor([](Gaussian<3>& z) { z.mean.y() = std::nan(""); }).find("argument: Gaussian 3"), 0u);
  EXPECT_EQ(messageFor([](Gaussian<3>& z) { z.cov(1, 1) = -1.0; }).find("domain: Gaussian 3"), 0u);
  EXPECT_EQ(messageFor([](Gaussian<3>& z) { z.cov.setOnes(); }).find("domain: Gaussian 3"), 0u);
  EXPECT_EQ(messageFor([](Gaussian<3>& z) { z.cov(2, 0) = std::nan(""); }).find("domain: Gaussian 3"), 0u);
  EXPECT_EQ(messageFor([](Gaussian<3>& z) { z.cov(0, 0) = HUGE_VAL; }).find("domain: Gaussian 3"), 0u);
}

TEST(KLKMeans, RefusesReferencesItCannotStartFrom) {
  Random random(2);
  const std::vector<Gaussian<2>> data = randomGaussians<2>(random, 5);
  EXPECT_THROW(KLKMeans<2>().run(data, {}), std::invalid_argument);
  std::vector<Gaussian<2>> centres = {data[0], data[1]};
  centres[1].cov.setZero();
  EXPECT_THROW(KLKMeans<2>().run(data, centres), std::domain_error);
}

TEST(KLKMeans, OfNothingIsEmpty) {
  EXPECT_TRUE(KLKMeans<3>().fit({}).centres.empty());
  EXPECT_TRUE(KLKMeans<3>().fit({}).labels.empty());
  EXPECT_EQ(KLKMeans<3>().fit({}).distortion, 0.0);
  EXPECT_TRUE(KLKMeans<3>().run({}, {}).centres.empty());
}

TEST(KLKMeans, LeavesEveryDatumAloneWhenThereAreEnoughClusters) {
  Random random(3);
  std::vector<Gaussian<3>> data = randomGaussians<3>(random, 4);
  data.push_back(data[0]);  // a duplicate too
  for (int k : {5, 6, 100}) {
    const KLClustering<3> clustering = KLKMeans<3>(withK(k)).fit(data);
    EXPECT_EQ(clustering.labels, (std::vector<int>{0, 1, 2, 3, 4}));
    EXPECT_EQ(clustering.distortion, 0.0);
    expectSound(data, clustering);
  }
  EXPECT_EQ(KLKMeans<3>(withK(1)).fit({data[0]}).centres.size(), 1u);
}

TEST(KLKMeans, FindsThePairsOfFourSpheresAndTheirDistortion) {
  // Unit spheres at x = 0, 1, 10, 11: each pair has 1 + 1/4 along x, so E = 4 * ln(5/4) / 2.
  std::vector<Gaussian<3>> data;
  for (double x : {0.0, 10.0, 1.0, 11.0}) data.push_back({{x, 0, 0}, Eigen::Matrix3d::Identity(), 1.0});
  const KLClustering<3> clustering = KLKMeans<3>(withK(2)).fit(data);
  EXPECT_EQ(clustering.labels[0], clustering.labels[2]);
  EXPECT_EQ(clustering.labels[1], clustering.labels[3]);
  EXPECT_NE(clustering.labels[0], clustering.labels[1]);
  EXPECT_NEAR(clustering.distortion, 2.0 * std::log(1.25), 1e-12);
  EXPECT_TRUE(clustering.converged);
}

TEST(KLKMeans, WeighsTheMeansByTheWeights) {  // weights 3 and 1 at x = 0 and 4: mean 1, variance 1 + 3/4 * 1/4 * 16
  const std::vector<Gaussian<2>> data = {{{0, 0}, Eigen::Matrix2d::Identity(), 3.0},
                                         {{4, 0}, Eigen::Matrix2d::Identity(), 1.0}};
  const KLClustering<2> clustering = KLKMeans<2>(withK(1)).fit(data);
  EXPECT_NEAR(clustering.centres[0].mean.x(), 1.0, 1e-14);
  EXPECT_NEAR(clustering.centres[0].cov(0, 0), 4.0, 1e-14);
  EXPECT_NEAR(clustering.distortion, 0.5 * 4.0 * std::log(4.0), 1e-12);
}

template <int D>
void expectNaiveAssignment() {
  Random random(4);
  for (std::size_t n : {1u, 7u, 255u, 256u, 257u, 1000u}) {  // around the block of the product
    const std::vector<Gaussian<D>> data = randomGaussians<D>(random, n), centres = randomGaussians<D>(random, 6);
    KLKMeansOptions options;
    options.max_iterations = 1;  // one assignment, one update
    const std::vector<int> labels = KLKMeans<D>(options).run(data, centres).labels;
    std::vector<int> expected = naiveLabels(data, centres);
    const std::set<int> used(expected.begin(), expected.end());  // labels move up when empty centres go
    for (int& label : expected) label = static_cast<int>(std::distance(used.begin(), used.find(label)));
    EXPECT_EQ(labels, expected) << n;
  }
}
TEST(KLKMeans, AssignsAsTheNaiveFormulaIn2D) {
  expectNaiveAssignment<2>();
}
TEST(KLKMeans, AssignsAsTheNaiveFormulaIn3D) {
  expectNaiveAssignment<3>();
}

template <int D>
void expectSoundResults() {
  Random random(5);
  for (int trial = 0; trial < 40; ++trial) {
    const std::vector<Gaussian<D>> data = randomGaussians<D>(random, 1 + random.below(60));
    const int k = 1 + static_cast<int>(random.below(8));
    const KLClustering<D> clustering = KLKMeans<D>(withK(k)).fit(data);
    EXPECT_LE(clustering.centres.size(), static_cast<std::size_t>(k));
    expectSound(data, clustering);
  }
}
TEST(KLKMeans, GivesMomentMatchesAndTheirDistortionIn2D) {
  expectSoundResults<2>();
}
TEST(KLKMeans, GivesMomentMatchesAndTheirDistortionIn3D) {
  expectSoundResults<3>();
}

TEST(KLKMeans, EndsWithEveryDatumAtItsNearestCentre) {
  Random random(6);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 200);
  KLKMeansOptions options = withK(5);
  options.tolerance = 0.0;
  options.max_iterations = 1000;
  const KLClustering<3> clustering = KLKMeans<3>(options).fit(data);
  EXPECT_TRUE(clustering.converged);
  EXPECT_EQ(clustering.labels, naiveLabels(data, clustering.centres));
}

TEST(KLKMeans, NeverRaisesTheDistortionFromOneIterationToTheNext) {
  Random random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 150);
    const std::vector<Gaussian<3>> start(data.begin(), data.begin() + 6);
    KLKMeansOptions options;
    options.tolerance = 0.0;
    double before = std::numeric_limits<double>::infinity();
    for (options.max_iterations = 1; options.max_iterations < 30; ++options.max_iterations) {
      const KLClustering<3> clustering = KLKMeans<3>(options).run(data, start);
      EXPECT_LE(clustering.distortion, before * (1.0 + 1e-12));
      EXPECT_LE(clustering.iterations, options.max_iterations);
      before = clustering.distortion;
      if (clustering.converged) break;
    }
  }
}

TEST(KLKMeans, SaysWhenItStoppedEarly) {
  Random random(8);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 300);
  KLKMeansOptions options;
  options.max_iterations = 1;
  EXPECT_FALSE(KLKMeans<3>(options).run(data, {data[0], data[1], data[2]}).converged);
}

TEST(KLKMeans, DropsReferencesWithoutMembers) {
  Random random(9);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 50);
  Gaussian<3> nobody = data[0];
  nobody.mean.x() += 1e6;
  const KLClustering<3> clustering = KLKMeans<3>().run(data, {nobody, data[0], nobody, data[1]});
  EXPECT_EQ(clustering.centres.size(), 2u);
  expectSound(data, clustering);
}

TEST(KLKMeans, BreaksTiesTowardsTheSmallerLabel) {
  Random random(10);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 50);
  const KLClustering<3> clustering = KLKMeans<3>().run(data, {data[7], data[7], data[7]});
  EXPECT_EQ(clustering.centres.size(), 1u);
  EXPECT_EQ(clustering.labels, std::vector<int>(50, 0));
  // A gaussian half-way between two centres, exactly.
  std::vector<Gaussian<2>> row;
  for (double x : {-1.0, 0.0, 1.0}) row.push_back({{x, 0}, Eigen::Matrix2d::Identity(), 1.0});
  KLKMeansOptions options;
  options.max_iterations = 1;
  EXPECT_EQ(KLKMeans<2>(options).run(row, {row[0], row[2]}).labels, (std::vector<int>{0, 0, 1}));
  EXPECT_EQ(KLKMeans<2>(options).run(row, {row[2], row[0]}).labels, (std::vector<int>{1, 0, 0}));
}

TEST(KLKMeans, PutsDuplicatesIntoOneCluster) {
  Random random(11);
  const std::vector<Gaussian<3>> two = randomGaussians<3>(random, 2);
  const KLClustering<3> one = KLKMeans<3>(withK(3)).fit(std::vector<Gaussian<3>>(10, two[0]));
  EXPECT_EQ(one.centres.size(), 1u);
  EXPECT_NEAR(one.distortion, 0.0, 1e-12);
  std::vector<Gaussian<3>> mixed;
  for (int i = 0; i < 10; ++i) mixed.push_back(two[std::size_t(i % 2)]);
  const KLClustering<3> both = KLKMeans<3>(withK(4)).fit(mixed);
  EXPECT_EQ(both.centres.size(), 2u);
  EXPECT_NEAR(both.distortion, 0.0, 1e-12);
  expectSound(mixed, both);
}

TEST(KLKMeans, LosesNothingFarFromTheOrigin) {
  Random random(12);
  std::vector<Gaussian<3>> data = wallsAndPole(random);
  const KLClustering<3> near = KLKMeans<3>(withK(4)).fit(data);
  for (Gaussian<3>& z : data) z.mean += Eigen::Vector3d(1e7, -1e7, 1e7);
  const KLClustering<3> far = KLKMeans<3>(withK(4)).fit(data);
  EXPECT_EQ(near.labels, far.labels);
  EXPECT_NEAR(near.distortion, far.distortion, 1e-4 * near.distortion);  // the data themselves were rounded
}

TEST(KLKMeans, FollowsAPermutationOfTheData) {
  Random random(13);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 100);
  const std::vector<Gaussian<3>> start(data.begin(), data.begin() + 5);
  const std::vector<Gaussian<3>> reversed(data.rbegin(), data.rend());
  const KLClustering<3> a = KLKMeans<3>().run(data, start), b = KLKMeans<3>().run(reversed, start);
  EXPECT_EQ(a.labels, std::vector<int>(b.labels.rbegin(), b.labels.rend()));
  EXPECT_NEAR(a.distortion, b.distortion, 1e-10 * a.distortion);
}

TEST(KLKMeans, GivesTheSameBytesForTheSameSeed) {
  Random random(14);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 100);
  const KLClustering<3> a = KLKMeans<3>(withK(6)).fit(data), b = KLKMeans<3>(withK(6)).fit(data);
  EXPECT_EQ(a.labels, b.labels);
  EXPECT_EQ(a.distortion, b.distortion);
  for (std::size_t c = 0; c < a.centres.size(); ++c) EXPECT_EQ(a.centres[c].cov, b.centres[c].cov);
}

TEST(KLKMeans, TellsTwoWallsAndAPoleApart) {
  Random random(15);
  const std::vector<Gaussian<3>> data = wallsAndPole(random);
  const KLClustering<3> clustering = KLKMeans<3>(withK(3)).fit(data);
  ASSERT_EQ(clustering.centres.size(), 3u);
  std::set<std::set<int>> labels_of_part;  // three parts, one label each, all different
  for (std::size_t part = 0; part < 3; ++part)
    labels_of_part.insert({clustering.labels.begin() + std::ptrdiff_t(part * kPatches),
                           clustering.labels.begin() + std::ptrdiff_t((part + 1) * kPatches)});
  EXPECT_EQ(labels_of_part, (std::set<std::set<int>>{{0}, {1}, {2}}));
}

}  // namespace
}  // namespace gaussmap
