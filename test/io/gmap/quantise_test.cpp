// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/quantise.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kNoise = 0.005, kSide = 1.0;

/// A Gaussian of a cell of one metre: standard deviations from the noise floor up, turned anyhow.
template <int D>
Gaussian<D> randomGaussian(Random& random) {
  Eigen::MatrixXd axes(D, D);
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) axes(i, j) = random.normal();
  const Eigen::MatrixXd turn = Eigen::HouseholderQR<Eigen::MatrixXd>(axes).householderQ();
  Vector<D> variances;
  Gaussian<D> gaussian;
  for (int i = 0; i < D; ++i) {
    variances(i) = std::pow(kNoise * std::pow(0.5 / kNoise, random.uniform()), 2);
    gaussian.mean(i) = random.uniform() - 0.5;
  }
  const Matrix<D> cov = turn * variances.asDiagonal() * turn.transpose();
  gaussian.cov = 0.5 * (cov + cov.transpose());
  gaussian.weight = std::floor(1.0 + std::pow(1e6, random.uniform()));
  return gaussian;
}

/// The bounds that finish() states.
template <int D>
void expectWithinBounds(const Gaussian<D>& exact, const Gaussian<D>& restored) {
  const Matrix<D> precision = restored.cov.inverse();
  for (int axis = 0; axis < D; ++axis)
    EXPECT_LE(std::abs(restored.mean(axis) - exact.mean(axis)) * std::sqrt(precision(axis, axis)), (1.0 + 1e-6) / 16.0);
  // Variances of the one in directions in which the other has variance 1: all directions at once.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(restored.cov, exact.cov);
  EXPECT_GE(std::sqrt(solver.eigenvalues().minCoeff()), 0.95);
  EXPECT_LE(std::sqrt(solver.eigenvalues().maxCoeff()), 1.05);
  EXPECT_LE(std::abs(restored.weight / exact.weight - 1.0), 1.0 / 32.0);
  EXPECT_EQ(Eigen::LLT<Matrix<D>>(restored.cov).info(), Eigen::Success);
}

template <int D>
void expectRandomOnesWithinBounds(std::uint64_t seed) {
  Random random(seed);
  double worst = 0.0;
  for (int round = 0; round < 20000; ++round) {
    const Gaussian<D> exact = randomGaussian<D>(random);
    const Gaussian<D> restored = dequantise<D>(quantise<D>(exact, kNoise), kNoise, kSide);
    expectWithinBounds<D>(exact, restored);
    if (testing::Test::HasFailure()) FAIL() << "round " << round;
    const double divergence = klDivergence<D>(exact, restored);
    worst = std::max(worst, divergence);
    const Gaussian<D> again = dequantise<D>(quantise<D>(restored, kNoise), kNoise, kSide);  // nothing more is lost
    EXPECT_EQ(again.cov, restored.cov);
    EXPECT_EQ(again.weight, restored.weight);
  }
  EXPECT_LT(worst, 0.05);   // [nat]
  EXPECT_GT(worst, 0.005);  // it is quantised
}

TEST(Quantise, KeepsWithinTheStatedBounds) {
  expectRandomOnesWithinBounds<3>(1);
  expectRandomOnesWithinBounds<2>(2);
}

TEST(Quantise, KeepsPowersOfTheNoiseFloorAsTheyAre) {
  for (const double sigma : {kNoise, 2 * kNoise, 64 * kNoise, kNoise / 1024}) {
    const Gaussian<3> sphere{{0, 0, 0}, sigma * sigma * Matrix<3>::Identity(), 7.0};
    const Gaussian<3> restored = dequantise<3>(quantise<3>(sphere, kNoise), kNoise, kSide);
    EXPECT_EQ(restored.mean, sphere.mean);
    EXPECT_TRUE(restored.cov.isApprox(sphere.cov, 1e-14));
    EXPECT_EQ(restored.weight, 7.0);
  }
}

TEST(Quantise, KeepsSmallCounts) {
  Gaussian<3> gaussian{{0, 0, 0}, Matrix<3>::Identity(), 1.0};
  for (int count = 1; count <= 32; ++count) {
    gaussian.weight = count;
    EXPECT_EQ(dequantise<3>(quantise<3>(gaussian, 1.0), 1.0, 1.0).weight, count);
  }
  for (const double weight : {1e-300, 1e-3, 33.0, 1e9, 1e300}) {
    gaussian.weight = weight;
    EXPECT_NEAR(dequantise<3>(quantise<3>(gaussian, 1.0), 1.0, 1.0).weight / weight, 1.0, 1.0 / 32.0);
  }
}

TEST(Quantise, KeepsMeansInTheirCell) {
  Gaussian<3> wide{{0.5, -0.5, 0.499}, 4.0 * Matrix<3>::Identity(), 1.0};  // steps of 25 cm
  const Gaussian<3> restored = dequantise<3>(quantise<3>(wide, kNoise), kNoise, kSide);
  EXPECT_LE(restored.mean.cwiseAbs().maxCoeff(), 0.501);
}

TEST(Quantise, RefusesWhatIsNoGaussian) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto refuses = [](const Gaussian<3>& gaussian) {
    EXPECT_THROW(quantise<3>(gaussian, kNoise), std::domain_error);
  };
  const Gaussian<3> good{{0, 0, 0}, 1e-4 * Matrix<3>::Identity(), 1.0};
  for (const double bad : {nan, infinity, -infinity, 0.0, -1.0}) {
    Gaussian<3> gaussian = good;
    gaussian.weight = bad;
    refuses(gaussian);
    gaussian = good;
    gaussian.cov(1, 1) = bad;
    refuses(gaussian);
    if (std::isfinite(bad)) continue;
    gaussian = good;
    gaussian.mean(2) = bad;
    refuses(gaussian);
  }
  QuantisedGaussian<3> numbers;
  numbers.weight = 16;
  EXPECT_NO_THROW(dequantise<3>(numbers, kNoise, kSide));
  for (const std::int64_t far : {std::int64_t{100000}, std::int64_t{-100000}, std::int64_t{1} << 61}) {
    numbers.diagonal[1] = far;
    EXPECT_THROW(dequantise<3>(numbers, kNoise, kSide), std::domain_error);
    numbers.diagonal[1] = 0;
    numbers.weight = far;
    EXPECT_THROW(dequantise<3>(numbers, kNoise, kSide), std::domain_error);
    numbers.weight = 16;
  }
}

TEST(Quantise, KeepsLogOdds) {
  for (const float value : {-10.0f, -0.03f, 0.0f, 2.71f, 10.0f})
    EXPECT_NEAR(dequantiseLogOdds(quantiseLogOdds(value)), value, 1.0f / 32.0f);
  EXPECT_EQ(dequantiseLogOdds(quantiseLogOdds(10.0f)), 10.0f);
  EXPECT_TRUE(std::isfinite(dequantiseLogOdds(quantiseLogOdds(3e38f))));
}

}  // namespace
}  // namespace gaussmap
