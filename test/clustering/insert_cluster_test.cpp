// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/clustering/kl_kmeans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "../src/clustering/kl_problem.h"  // inner parts, not installed
#include "clustering/random_gaussians.h"

namespace gaussmap {
using namespace detail;

namespace {

Gaussian<3> sphere(double x, double sigma, double weight = 1.0) {
  return {{x, 0, 0}, sigma * sigma * Eigen::Matrix3d::Identity(), weight};
}

TEST(InsertCluster, StartsWithOneClusterForAll) {
  Random random(1);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 20);
  const KLClustering<3> clustering = insertCluster(data, {});
  ASSERT_EQ(clustering.centres.size(), 1u);
  EXPECT_EQ(clustering.labels, std::vector<int>(20, 0));
  EXPECT_EQ(clustering.centres[0].cov, merge(data).cov);
}

TEST(InsertCluster, OfNothingIsEmpty) {
  EXPECT_TRUE(insertCluster<3>({}, {}).centres.empty());
  EXPECT_TRUE(insertCluster<3>({}, {sphere(0, 1)}).centres.empty());
}

template <int D>
void expectOneMoreAndLessDistortion() {
  Random random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const std::vector<Gaussian<D>> data = randomGaussians<D>(random, 40);
    KLClustering<D> clustering = insertCluster<D>(data, {});
    for (std::size_t k = 2; k <= 8; ++k) {
      KLClustering<D> more = insertCluster(data, clustering.centres);
      EXPECT_EQ(more.centres.size(), k);
      EXPECT_LT(more.distortion, clustering.distortion);
      clustering = std::move(more);
    }
  }
}
TEST(InsertCluster, AddsOneClusterAndLowersTheDistortionIn2D) {
  expectOneMoreAndLessDistortion<2>();
}
TEST(InsertCluster, AddsOneClusterAndLowersTheDistortionIn3D) {
  expectOneMoreAndLessDistortion<3>();
}

TEST(InsertCluster, GivesEveryDatumItsOwnClusterWhenThereAreEnough) {
  const std::vector<Gaussian<3>> data = {sphere(0, 1), sphere(1, 1), sphere(2, 1)};
  const KLClustering<3> clustering = insertCluster(data, {sphere(0, 1), sphere(2, 1)});
  EXPECT_EQ(clustering.labels, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(clustering.distortion, 0.0);
  EXPECT_EQ(clustering.centres[1].mean, data[1].mean);
}

TEST(InsertCluster, DoesNotSplitDuplicates) {
  const std::vector<Gaussian<3>> data(10, sphere(3, 0.2));
  for (ClusterSeed rule : {ClusterSeed::ParentCovariance, ClusterSeed::InputGaussian}) {
    KLKMeansOptions options;
    options.seed_rule = rule;
    const KLClustering<3> clustering = insertCluster(data, {data[0]}, options);
    EXPECT_EQ(clustering.centres.size(), 1u);
    EXPECT_NEAR(clustering.distortion, 0.0, 1e-12);
  }
}

TEST(InsertCluster, SeparatesAPoleFromAWall) {
  Random random(3);
  std::vector<Gaussian<3>> data = wallsAndPole(random);
  data.erase(data.begin(), data.begin() + kPatches);  // one wall and the pole stay
  const KLClustering<3> clustering = insertCluster(data, {merge(data)});
  ASSERT_EQ(clustering.centres.size(), 2u);
  for (std::size_t j = 0; j < data.size(); ++j)
    EXPECT_EQ(clustering.labels[j], clustering.labels[j < kPatches ? 0 : kPatches]) << j;
}

TEST(InsertCluster, TakesNeighboursAlongOnlyWithTheParentsCovariance) {
  Random random(4);
  const std::vector<Gaussian<3>> data = wallsAndPole(random);
  const auto smallerCluster = [&](ClusterSeed rule) {
    KLKMeansOptions options;
    options.seed_rule = rule;
    options.max_swaps = 0;
    const std::vector<int> labels = insertCluster(data, {merge(data)}, options).labels;
    const auto ones = std::count(labels.begin(), labels.end(), 1);
    return std::min<std::ptrdiff_t>(ones, std::ptrdiff_t(labels.size()) - ones);
  };
  EXPECT_GT(smallerCluster(ClusterSeed::ParentCovariance), 20);
  EXPECT_LT(smallerCluster(ClusterSeed::InputGaussian), 5);
}

TEST(InsertCluster, SeedsAtTheFarGaussianNotAtTheHeavyOne) {
  // A crowd at 0, a light stray at x = 8, heavy data at x = -6: the stray is farther, the heavy ones cost more.
  std::vector<Gaussian<3>> data;
  for (int i = 0; i < 40; ++i) data.push_back(sphere(0.01 * i - 0.2, 0.3, 10.0));
  data.push_back(sphere(8.0, 0.3, 0.1));
  for (int i = 0; i < 3; ++i) data.push_back(sphere(-6.0 + 0.01 * i, 0.3, 5.0));
  KLKMeansOptions options;
  options.max_swaps = 0;
  const std::vector<int> far = insertCluster(data, {sphere(0, 1)}, options).labels;
  EXPECT_EQ(std::count(far.begin(), far.end(), far[40]), 1);
}

TEST(KLProblem, GivesTheDivergencesOfThePaper) {  // what the swap loop compares: d_max with d_min
  Random random(8);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 300), centres = randomGaussians<3>(random, 5);
  const KLProblem<3> problem(data);
  KLPartition<3> partition;
  partition.centres = centres;
  for (Gaussian<3>& w : partition.centres) w.mean -= problem.centre();
  problem.assign(partition.centres, partition.assignment);
  partition.labels = partition.assignment.labels;
  const Eigen::VectorXd own = problem.ownDistances(partition);
  for (std::size_t j = 0; j < data.size(); ++j)
    EXPECT_NEAR(own(Eigen::Index(j)), klDivergence(data[j], centres[std::size_t(partition.labels[j])]),
                1e-10 * (1.0 + own(Eigen::Index(j))));
  const Eigen::MatrixXd between = problem.distancesBetween(centres);
  for (Eigen::Index u = 0; u < 5; ++u)
    for (Eigen::Index v = 0; v < 5; ++v)
      EXPECT_NEAR(between(u, v), klDivergence(centres[std::size_t(u)], centres[std::size_t(v)]),
                  1e-10 * (1.0 + between(u, v)));
}

TEST(InsertCluster, NeverLosesBySwapping) {
  Random random(5);
  int swapped = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 80);
    const std::vector<Gaussian<3>> current(data.begin(), data.begin() + 4);
    KLKMeansOptions options;
    options.seed = static_cast<std::uint64_t>(trial);
    double before = std::numeric_limits<double>::infinity();
    for (options.max_swaps = 0; options.max_swaps < 6; ++options.max_swaps) {  // the same draws, one more each time
      const KLClustering<3> clustering = insertCluster(data, current, options);
      EXPECT_LE(clustering.swaps, options.max_swaps);
      EXPECT_EQ(clustering.centres.size(), 5u);
      if (clustering.swaps == options.max_swaps && options.max_swaps > 0)
        EXPECT_LT(clustering.distortion, before);
      else
        EXPECT_LE(clustering.distortion, before);
      before = clustering.distortion;
      swapped += clustering.swaps;
    }
  }
  EXPECT_GT(swapped, 10);  // else nothing was tested
}

TEST(InsertCluster, GivesTheSameForTheSameSeedAndLooksAtItOnlyToSwap) {
  Random random(6);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 80);
  const std::vector<Gaussian<3>> current(data.begin(), data.begin() + 4);
  KLKMeansOptions options;
  options.seed = 7;
  EXPECT_EQ(insertCluster(data, current, options).labels, insertCluster(data, current, options).labels);
  options.max_swaps = 0;
  const std::vector<int> plain = insertCluster(data, current, options).labels;
  options.seed = 8;
  EXPECT_EQ(insertCluster(data, current, options).labels, plain);
}

TEST(InsertCluster, LosesNothingFarFromTheOrigin) {
  Random random(7);
  std::vector<Gaussian<3>> data = wallsAndPole(random);
  const std::vector<int> near = insertCluster(data, {merge(data)}).labels;
  for (Gaussian<3>& z : data) z.mean += Eigen::Vector3d(1e7, -1e7, 1e7);
  EXPECT_EQ(insertCluster(data, {merge(data)}).labels, near);
}

TEST(InsertCluster, RefusesBadOptionsDataAndReferences) {
  const std::vector<Gaussian<3>> data = {sphere(0, 1), sphere(1, 1), sphere(2, 1), sphere(3, 1)};
  KLKMeansOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(insertCluster(data, {sphere(0, 1)}, options), std::invalid_argument);
  EXPECT_THROW(insertCluster(data, {sphere(0, 0)}), std::domain_error);
  EXPECT_THROW(insertCluster<3>({sphere(0, 1), sphere(1, 1, 0.0), sphere(2, 1)}, {sphere(0, 1)}),
               std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
