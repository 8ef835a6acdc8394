// SPDX-License-Identifier: BSD-3-Clause
// The fast forms of the distances against gaussianDistance(), pair by pair.
#include "clustering/centre_distances.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "clustering/distance_kernels.h"
#include "clustering/kl_problem.h"
#include "clustering/random_gaussians.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr GaussianDistance kDistances[] = {GaussianDistance::KL, GaussianDistance::SymmetricKL,
                                           GaussianDistance::Bhattacharyya, GaussianDistance::Wasserstein};

template <int D>
void expectDistancesOfPairs() {
  Random random(D);
  const std::vector<Gaussian<D>> data = randomGaussians<D>(random, 600);  // more than two blocks
  for (const GaussianDistance distance : kDistances) {
    const KLProblem<D> problem(data, distance);
    KLPartition<D> partition;
    for (std::size_t j = 0; j < 9; ++j) partition.centres.push_back(problem.input(60 * j + 1));
    problem.assign(partition.centres, partition.assignment);
    partition.labels = partition.assignment.labels;
    const Eigen::VectorXd own = problem.ownDistances(partition);
    for (std::size_t j = 0; j < data.size(); ++j) {
      std::vector<double> all;
      for (const Gaussian<D>& w : partition.centres) all.push_back(gaussianDistance(problem.input(j), w, distance));
      const double least = *std::min_element(all.begin(), all.end());
      ASSERT_NEAR(own(static_cast<Eigen::Index>(j)), least, 1e-9 * (1.0 + least)) << static_cast<int>(distance);
      ASSERT_NEAR(all[static_cast<std::size_t>(partition.labels[j])], least, 1e-9 * (1.0 + least));
    }
    const Eigen::MatrixXd between = problem.distancesBetween(partition.centres);
    for (Eigen::Index u = 0; u < between.rows(); ++u)
      for (Eigen::Index v = 0; v < between.cols(); ++v) {
        const double expected = gaussianDistance(partition.centres[static_cast<std::size_t>(u)],
                                                 partition.centres[static_cast<std::size_t>(v)], distance);
        ASSERT_NEAR(between(u, v), expected, 1e-9 * (1.0 + expected)) << static_cast<int>(distance);
      }
  }
}
TEST(CentreDistances, AreThoseOfEveryPairIn2D) {
  expectDistancesOfPairs<2>();
}
TEST(CentreDistances, AreThoseOfEveryPairIn3D) {
  expectDistancesOfPairs<3>();
}

TEST(CentreDistances, KeepTheirDigitsForNeedlesAndDiscs) {  // of W2, which subtracts large numbers
  Random random(3);
  std::vector<Gaussian<3>> data = randomGaussians<3>(random, 300);
  for (Gaussian<3>& z : data)  // deviations from a millimetre to 10 m along the axes, a little turned by the first cov
    z.cov = 1e-7 * z.cov + Eigen::Matrix3d(Eigen::Vector3d(std::pow(10.0, 2.0 - 6.0 * random.uniform()),
                                                           std::pow(10.0, 2.0 - 6.0 * random.uniform()),
                                                           std::pow(10.0, 2.0 - 6.0 * random.uniform()))
                                               .asDiagonal());
  for (const GaussianDistance distance : {GaussianDistance::Bhattacharyya, GaussianDistance::Wasserstein}) {
    const KLProblem<3> problem(data, distance);
    const std::vector<Gaussian<3>> centres(data.begin(), data.begin() + 30);
    const Eigen::MatrixXd between = problem.distancesBetween(centres);
    for (std::size_t u = 0; u < 30; ++u)
      for (std::size_t v = 0; v < 30; ++v) {
        const double expected = gaussianDistance(centres[u], centres[v], distance);
        const double size =
            distance == GaussianDistance::Wasserstein ? centres[u].cov.trace() + centres[v].cov.trace() : 1e3;
        ASSERT_NEAR(between(Eigen::Index(u), Eigen::Index(v)), expected, 1e-13 * (size + expected));
      }
  }
}

TEST(NuclearNorm, IsTheSumOfTheSingularValues) {
  Random random(4);
  for (int trial = 0; trial < 2000; ++trial) {
    Eigen::Matrix3d a;
    Eigen::Matrix2d b;
    for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = random.normal() * std::pow(10.0, -4.0 * (i % 3));
    for (int i = 0; i < 4; ++i) b(i / 2, i % 2) = random.normal() * std::pow(10.0, -4.0 * (i % 2));
    if (a.determinant() < 0.0) a.row(0) *= -1.0;
    if (b.determinant() < 0.0) b.row(0) *= -1.0;
    const double expected = Eigen::JacobiSVD<Eigen::Matrix3d>(a).singularValues().sum();
    EXPECT_NEAR(nuclearNorm(a, a.determinant()), expected, 1e-14 * expected);
    const double planar = Eigen::JacobiSVD<Eigen::Matrix2d>(b).singularValues().sum();
    EXPECT_NEAR(nuclearNorm(Matrix<2>(b), b.determinant()), planar, 1e-14 * planar);
  }
  EXPECT_NEAR(nuclearNorm(Eigen::Matrix3d(2.0 * Eigen::Matrix3d::Identity()), 8.0), 6.0, 1e-14);
  EXPECT_EQ(nuclearNorm(Eigen::Matrix3d(Eigen::Vector3d(5, 0, 0).asDiagonal()), 0.0), 5.0);
}

}  // namespace
}  // namespace gaussmap
