// SPDX-License-Identifier: BSD-3-Clause
// KLKMeans and insertCluster() with every GaussianDistance.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "clustering/random_gaussians.h"
#include "gaussmap/clustering/kl_kmeans.h"

namespace gaussmap {
namespace {

constexpr GaussianDistance kOthers[] = {GaussianDistance::SymmetricKL, GaussianDistance::Bhattacharyya,
                                        GaussianDistance::Wasserstein};

KLKMeansOptions with(GaussianDistance distance, int k = 8) {
  KLKMeansOptions options;
  options.distance = distance;
  options.k = k;
  return options;
}

/// The distortion of a clustering, pair by pair.
template <int D>
double distortionOf(const std::vector<Gaussian<D>>& data, const KLClustering<D>& clustering,
                    GaussianDistance distance) {
  double sum = 0.0;
  for (std::size_t j = 0; j < data.size(); ++j)
    sum += data[j].weight *
           gaussianDistance(data[j], clustering.centres[static_cast<std::size_t>(clustering.labels[j])], distance);
  return sum;
}

/// What every result promises.
template <int D>
void expectSoundClustering(const std::vector<Gaussian<D>>& data, const KLClustering<D>& clustering,
                           GaussianDistance distance) {
  const double expected = distortionOf(data, clustering, distance);
  EXPECT_NEAR(clustering.distortion, expected, 1e-8 * (1.0 + expected));
  std::vector<std::vector<Gaussian<D>>> members(clustering.centres.size());
  for (std::size_t j = 0; j < data.size(); ++j)
    members.at(static_cast<std::size_t>(clustering.labels[j])).push_back(data[j]);
  for (std::size_t c = 0; c < members.size(); ++c) {
    ASSERT_FALSE(members[c].empty());
    EXPECT_EQ(clustering.centres[c].mean, merge(members[c]).mean);
    EXPECT_EQ(clustering.centres[c].cov, merge(members[c]).cov);
  }
}

/// K-means as it is described, with gaussianDistance() and merge() only. Returns the labels.
template <int D>
std::vector<int> plainKMeans(const std::vector<Gaussian<D>>& data, std::vector<Gaussian<D>> centres,
                             const KLKMeansOptions& options) {
  std::vector<int> labels;
  double distortion = HUGE_VAL;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    std::vector<int> nearest;
    for (const Gaussian<D>& z : data) {
      int best = 0;
      for (int c = 1; c < static_cast<int>(centres.size()); ++c)
        if (gaussianDistance(z, centres[std::size_t(c)], options.distance) <
            gaussianDistance(z, centres[std::size_t(best)], options.distance))
          best = c;
      nearest.push_back(best);
    }
    const std::set<int> used(nearest.begin(), nearest.end());  // empty clusters are dropped
    KLClustering<D> next;
    for (const int label : used) {
      std::vector<Gaussian<D>> members;
      for (std::size_t j = 0; j < data.size(); ++j)
        if (nearest[j] == label) members.push_back(data[j]);
      next.centres.push_back(merge(members));
    }
    for (const int label : nearest)
      next.labels.push_back(static_cast<int>(std::distance(used.begin(), used.find(label))));
    const double now = distortionOf(data, next, options.distance);
    if (next.labels == labels || now > distortion) break;
    const bool is_last = distortion - now < options.tolerance * distortion;
    labels = next.labels;
    centres = next.centres;
    distortion = now;
    if (is_last) break;
  }
  return labels;
}

template <int D>
void expectPlainKMeans(GaussianDistance distance) {
  Random random(20 + D);
  for (int trial = 0; trial < 25; ++trial) {
    const std::vector<Gaussian<D>> data = randomGaussians<D>(random, 20 + random.below(60));
    const std::vector<Gaussian<D>> start(data.begin(), data.begin() + 5);
    const KLClustering<D> clustering = KLKMeans<D>(with(distance)).run(data, start);
    EXPECT_EQ(clustering.labels, plainKMeans(data, start, with(distance)))
        << trial << ", distance " << static_cast<int>(distance);
    expectSoundClustering(data, clustering, distance);
  }
}
TEST(KMeansDistances, ClusterLikePlainKMeansIn2D) {
  for (const GaussianDistance distance : kOthers) expectPlainKMeans<2>(distance);
}
TEST(KMeansDistances, ClusterLikePlainKMeansIn3D) {
  for (const GaussianDistance distance : kOthers) expectPlainKMeans<3>(distance);
}

TEST(KMeansDistances, UseTheKLDivergenceByDefault) {
  Random random(1);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 100);
  KLKMeansOptions options;
  options.k = 6;
  EXPECT_EQ(KLKMeans<3>(options).fit(data).labels, KLKMeans<3>(with(GaussianDistance::KL, 6)).fit(data).labels);
}

TEST(KMeansDistances, GiveFourDifferentPartitions) {
  Random random(2);
  const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 100);
  std::set<std::vector<int>> partitions = {KLKMeans<3>(with(GaussianDistance::KL, 6)).fit(data).labels};
  for (const GaussianDistance distance : kOthers) partitions.insert(KLKMeans<3>(with(distance, 6)).fit(data).labels);
  EXPECT_EQ(partitions.size(), 4u);
}

/// A point-like Gaussian at 0, a long needle and a second point-like Gaussian 1 m away along the needle.
TEST(KMeansDistances, DisagreeOverANeedleThroughAPoint) {
  const Gaussian<2> point{{0.0, 0.0}, 1e-4 * Eigen::Matrix2d::Identity(), 1.0};
  const Gaussian<2> far{{1.0, 0.0}, 1e-4 * Eigen::Matrix2d::Identity(), 1.0};
  Gaussian<2> needle{{0.0, 0.0}, 1e-4 * Eigen::Matrix2d::Identity(), 1.0};
  needle.cov(0, 0) = 4.0;  // 2 m long
  KLKMeansOptions options;
  options.max_iterations = 1;
  const auto joinsTheNeedle = [&](GaussianDistance distance) {
    options.distance = distance;
    return KLKMeans<2>(options).run({point, needle, far}, {point, needle}).labels[2] == 1;
  };
  // KL(far || needle) = (1/4 + ...)/2 is small, but far is 100 deviations from the point.
  EXPECT_TRUE(joinsTheNeedle(GaussianDistance::KL));
  EXPECT_TRUE(joinsTheNeedle(GaussianDistance::Bhattacharyya));
  // J(far, needle) contains KL(needle || far) = about 4e4 / 2 + 1e4 / 2, J(far, point) is 1e4.
  EXPECT_FALSE(joinsTheNeedle(GaussianDistance::SymmetricKL));
  // W^2: 1 m^2 to the point, 1 + (2 - 0.01)^2 m^2 to the needle.
  EXPECT_FALSE(joinsTheNeedle(GaussianDistance::Wasserstein));
}

TEST(KMeansDistances, NeverReturnMoreDistortionThanTheFirstAssignment) {
  Random random(3);
  int rises = 0, runs = 0;
  for (const GaussianDistance distance : kOthers)
    for (int trial = 0; trial < 60; ++trial) {
      const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 40);
      const std::vector<Gaussian<3>> start(data.begin(), data.begin() + 6);
      KLKMeansOptions options = with(distance);
      options.tolerance = 0.0;
      options.max_iterations = 1000;
      const KLClustering<3> end = KLKMeans<3>(options).run(data, start);
      EXPECT_TRUE(end.converged);
      EXPECT_LT(end.iterations, 100);
      double before = HUGE_VAL;
      for (options.max_iterations = 1; options.max_iterations <= end.iterations; ++options.max_iterations) {
        const KLClustering<3> clustering = KLKMeans<3>(options).run(data, start);
        EXPECT_LE(clustering.distortion, before);  // the best so far
        before = clustering.distortion;
      }
      EXPECT_EQ(end.distortion, before);
      // One more iteration from the result can be worse. Otherwise this test would not show that the run stops then.
      options.max_iterations = 1;
      rises += KLKMeans<3>(options).run(data, end.centres).distortion > end.distortion * (1.0 + 1e-9);
      ++runs;
    }
  EXPECT_GT(rises, 0);
  EXPECT_LT(rises, runs);
}

template <int D>
void expectSoundInsertions(GaussianDistance distance) {
  Random random(4);
  int added = 0, insertions = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const std::vector<Gaussian<D>> data = randomGaussians<D>(random, 40);
    for (const ClusterSeed rule : {ClusterSeed::ParentCovariance, ClusterSeed::InputGaussian}) {
      KLKMeansOptions options = with(distance);
      options.seed_rule = rule;
      KLClustering<D> clustering = insertCluster<D>(data, {}, options);
      for (int step = 0; step < 7; ++step) {
        KLKMeansOptions one = options;
        one.max_iterations = 1;  // the moment matches of the Gaussians nearest to each centre
        const double start = KLKMeans<D>(one).run(data, clustering.centres).distortion;
        const KLClustering<D> more = insertCluster<D>(data, clustering.centres, options);
        EXPECT_LE(more.distortion, start * (1.0 + 1e-12));
        EXPECT_LE(more.centres.size(), clustering.centres.size() + 1);
        expectSoundClustering(data, more, distance);
        added += more.centres.size() == clustering.centres.size() + 1;
        ++insertions;
        clustering = more;
      }
    }
  }
  EXPECT_GT(added, insertions * 9 / 10);
}
TEST(KMeansDistances, InsertAClusterAndNeverLoseIn2D) {
  for (const GaussianDistance distance : kOthers) expectSoundInsertions<2>(distance);
}
TEST(KMeansDistances, InsertAClusterAndNeverLoseIn3D) {
  for (const GaussianDistance distance : kOthers) expectSoundInsertions<3>(distance);
}

TEST(KMeansDistances, NeverLoseBySwapping) {
  Random random(5);
  int swapped = 0;
  for (const GaussianDistance distance : kOthers)
    for (int trial = 0; trial < 20; ++trial) {
      const std::vector<Gaussian<3>> data = randomGaussians<3>(random, 60);
      const std::vector<Gaussian<3>> current(data.begin(), data.begin() + 4);
      KLKMeansOptions options = with(distance);
      options.seed = static_cast<std::uint64_t>(trial);
      options.max_swaps = 0;
      const double before = insertCluster(data, current, options).distortion;
      options.max_swaps = 20;
      const KLClustering<3> after = insertCluster(data, current, options);
      EXPECT_LE(after.distortion, before);
      swapped += after.swaps;
    }
  EXPECT_GT(swapped, 10);
}

TEST(KMeansDistances, SeparateTwoWallsAndAPole) {
  Random random(6);
  const std::vector<Gaussian<3>> data = wallsAndPole(random);
  for (const GaussianDistance distance : kOthers) {
    const KLClustering<3> clustering = KLKMeans<3>(with(distance, 3)).fit(data);
    ASSERT_EQ(clustering.centres.size(), 3u);
    std::set<std::set<int>> labels_of_part;  // three parts, one label each, all different
    for (std::size_t part = 0; part < 3; ++part)
      labels_of_part.insert({clustering.labels.begin() + std::ptrdiff_t(part * kPatches),
                             clustering.labels.begin() + std::ptrdiff_t((part + 1) * kPatches)});
    EXPECT_EQ(labels_of_part, (std::set<std::set<int>>{{0}, {1}, {2}})) << static_cast<int>(distance);
  }
}

TEST(KMeansDistances, PutDuplicatesIntoOneCluster) {
  Random random(7);
  const std::vector<Gaussian<3>> two = randomGaussians<3>(random, 2);
  for (const GaussianDistance distance : kOthers) {
    const KLClustering<3> one = KLKMeans<3>(with(distance, 3)).fit(std::vector<Gaussian<3>>(10, two[0]));
    EXPECT_EQ(one.centres.size(), 1u);
    EXPECT_NEAR(one.distortion, 0.0, 1e-12);
    EXPECT_EQ(insertCluster(std::vector<Gaussian<3>>(10, two[0]), {two[0]}, with(distance)).centres.size(), 1u);
  }
}

TEST(KMeansDistances, LoseNothingFarFromTheOrigin) {
  Random random(8);
  std::vector<Gaussian<3>> data = wallsAndPole(random);
  std::vector<std::vector<int>> near;
  for (const GaussianDistance distance : kOthers) near.push_back(KLKMeans<3>(with(distance, 4)).fit(data).labels);
  for (Gaussian<3>& z : data) z.mean += Eigen::Vector3d(1e6, -1e6, 1e6);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(KLKMeans<3>(with(kOthers[i], 4)).fit(data).labels, near[i]);
}

TEST(KMeansDistances, RefuseAValueThatIsNoDistance) {
  const std::vector<Gaussian<2>> data = {Gaussian<2>{{0, 0}, Eigen::Matrix2d::Identity(), 1.0}};
  EXPECT_THROW(KLKMeans<2>(with(static_cast<GaussianDistance>(9))).fit(data), std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
