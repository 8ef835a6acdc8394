// SPDX-License-Identifier: BSD-3-Clause
// The distances between Gaussians beside the KL divergence.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "clustering/random_gaussians.h"
#include "gaussmap/core/gaussian.h"

namespace gaussmap {
namespace {

constexpr GaussianDistance kDistances[] = {GaussianDistance::KL, GaussianDistance::SymmetricKL,
                                           GaussianDistance::Bhattacharyya, GaussianDistance::Wasserstein};

Gaussian<3> sphere(double x, double sigma) {
  return {{x, 0, 0}, sigma * sigma * Eigen::Matrix3d::Identity(), 1.0};
}

template <int D>
Gaussian<D> along(const Vector<D>& deviations, const Vector<D>& mean = Vector<D>::Zero()) {
  Gaussian<D> gaussian{mean, Matrix<D>::Zero(), 1.0};
  gaussian.cov.diagonal() = deviations.cwiseAbs2();
  return gaussian;
}

TEST(SymmetricKLDivergence, OfEqualSpheresIsTheSquaredDistanceInStandardDeviations) {  // 2^2 / 0.5^2
  EXPECT_NEAR(symmetricKLDivergence(sphere(0, 0.5), sphere(2, 0.5)), 16.0, 1e-12);
}

TEST(SymmetricKLDivergence, OfConcentricSpheresDependsOnTheRatioOfTheirRadii) {  // D/2 (r - 1/r)^2, r = 2
  EXPECT_NEAR(symmetricKLDivergence(sphere(0, 1.0), sphere(0, 0.5)), 1.5 * 1.5 * 1.5, 1e-12);
}

TEST(BhattacharyyaDistance, OfEqualSpheresIsAnEighthOfTheSquaredDistance) {
  EXPECT_NEAR(bhattacharyyaDistance(sphere(0, 0.5), sphere(2, 0.5)), 16.0 / 8.0, 1e-12);
}

TEST(BhattacharyyaDistance, OfConcentricSpheresIsALogarithm) {  // D/2 ln((r + 1/r) / 2), r = 2
  EXPECT_NEAR(bhattacharyyaDistance(sphere(0, 1.0), sphere(0, 0.5)), 1.5 * std::log(1.25), 1e-12);
}

TEST(WassersteinSquared, OfSpheresAddsTheDistancesOfMeansAndDeviations) {  // 2^2 + D (1 - 0.5)^2
  EXPECT_NEAR(wassersteinSquared(sphere(0, 0.5), sphere(2, 0.5)), 4.0, 1e-12);
  EXPECT_NEAR(wassersteinSquared(sphere(0, 1.0), sphere(0, 0.5)), 0.75, 1e-12);
  EXPECT_NEAR(wassersteinSquared(sphere(0, 1.0), sphere(2, 0.5)), 4.75, 1e-12);
}

TEST(GaussianDistance, OfEqualCovariancesIsAMultipleOfTheMahalanobisDistance) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Gaussian<3>> pair = randomGaussians<3>(random, 2);
    pair[1].cov = pair[0].cov;
    const double squared = mahalanobisSquared(pair[1].mean, pair[0]);
    EXPECT_NEAR(klDivergence(pair[0], pair[1]), squared / 2.0, 1e-9 * (1.0 + squared));
    EXPECT_NEAR(symmetricKLDivergence(pair[0], pair[1]), squared, 1e-9 * (1.0 + squared));
    EXPECT_NEAR(bhattacharyyaDistance(pair[0], pair[1]), squared / 8.0, 1e-9 * (1.0 + squared));
    const double apart = (pair[0].mean - pair[1].mean).squaredNorm();
    EXPECT_NEAR(wassersteinSquared(pair[0], pair[1]), apart, 1e-12 * (1.0 + apart));
  }
}

TEST(GaussianDistance, OfCommutingCovariancesIsASumOverTheAxes) {
  const Vector<2> p{3.0, 0.5}, q{1.0, 2.0};  // deviations along x and y, ratios 3 and 1/4
  const Gaussian<2> a = along<2>(p), b = along<2>(q);
  EXPECT_NEAR(symmetricKLDivergence(a, b), 0.5 * (std::pow(3.0 - 1.0 / 3.0, 2) + std::pow(4.0 - 0.25, 2)), 1e-12);
  EXPECT_NEAR(bhattacharyyaDistance(a, b), 0.5 * std::log(5.0 / 3.0) + 0.5 * std::log(2.125), 1e-12);
  EXPECT_NEAR(wassersteinSquared(a, b), 4.0 + 2.25, 1e-12);  // (3 - 1)^2 + (0.5 - 2)^2
  const Eigen::Rotation2Dd turn(0.7);
  Gaussian<2> turned_a = a, turned_b = b;
  turned_a.cov = turn * a.cov * turn.inverse();
  turned_b.cov = turn * b.cov * turn.inverse();
  for (const GaussianDistance distance : kDistances)
    EXPECT_NEAR(gaussianDistance(turned_a, turned_b, distance), gaussianDistance(a, b, distance), 1e-12);
}

TEST(WassersteinSquared, OfCrossedNeedlesIsThatOfTheFormula) {  // one needle along x, one along y: S1 S2 = t^2 I
  const double length = 10.0, thickness = 1e-4;
  const Gaussian<2> a = along<2>({length, thickness}), b = along<2>({thickness, length});
  EXPECT_NEAR(wassersteinSquared(a, b), 2.0 * std::pow(length - thickness, 2), 1e-10);
  EXPECT_NEAR(wassersteinSquared(a, along<2>({length, 2.0 * thickness})), 1e-8, 1e-20);  // (2 t - t)^2, no digit lost
}

/// The printed formulas with matrix functions.
template <int D>
double printed(const Gaussian<D>& p, const Gaussian<D>& q, GaussianDistance distance) {
  using Plain = Eigen::Matrix<double, D, D>;
  const Plain sp = p.cov, sq = q.cov;
  const Eigen::Matrix<double, D, 1> apart = q.mean - p.mean;
  switch (distance) {
    case GaussianDistance::KL:
      return 0.5 * ((sq.inverse() * sp).trace() + apart.dot(sq.inverse() * apart) - D +
                    std::log(sq.determinant() / sp.determinant()));
    case GaussianDistance::SymmetricKL:
      return printed(p, q, GaussianDistance::KL) + printed(q, p, GaussianDistance::KL);
    case GaussianDistance::Bhattacharyya: {
      const Plain average = 0.5 * (sp + sq);
      return apart.dot(average.inverse() * apart) / 8.0 +
             0.5 * std::log(average.determinant() / std::sqrt(sp.determinant() * sq.determinant()));
    }
    case GaussianDistance::Wasserstein: {
      const Plain root = Eigen::SelfAdjointEigenSolver<Plain>(sp).operatorSqrt();
      const Plain inner = root * sq * root;
      return apart.squaredNorm() + sp.trace() + sq.trace() -
             2.0 * Eigen::SelfAdjointEigenSolver<Plain>(inner).operatorSqrt().trace();
    }
  }
  return std::nan("");
}

template <int D>
void expectPrintedFormulas() {
  Random random(2);
  const std::vector<Gaussian<D>> gaussians = randomGaussians<D>(random, 60);
  for (const GaussianDistance distance : kDistances)
    for (const Gaussian<D>& p : gaussians)
      for (const Gaussian<D>& q : gaussians) {
        const double expected = printed(p, q, distance);
        ASSERT_NEAR(gaussianDistance(p, q, distance), expected, 1e-8 * (1.0 + expected)) << static_cast<int>(distance);
      }
}
TEST(GaussianDistance, IsThePrintedFormulaIn2D) {
  expectPrintedFormulas<2>();
}
TEST(GaussianDistance, IsThePrintedFormulaIn3D) {
  expectPrintedFormulas<3>();
}

/// Discs and needles with deviations from a millimetre to 10 m.
template <int D>
std::vector<Gaussian<D>> thinGaussians(Random& random, std::size_t n) {
  std::vector<Gaussian<D>> gaussians = randomGaussians<D>(random, n);
  for (Gaussian<D>& gaussian : gaussians) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> axes(gaussian.cov);
    Vector<D> variances;
    for (int i = 0; i < D; ++i) variances(i) = std::pow(10.0, 2.0 * (4.0 * random.uniform() - 3.0));
    const Eigen::Matrix<double, D, D> cov =
        axes.eigenvectors() * variances.asDiagonal() * axes.eigenvectors().transpose();
    gaussian.cov = 0.5 * (cov + cov.transpose());
  }
  return gaussians;
}

template <int D>
void expectZeroOnlyIfEqualAndSymmetric() {
  Random random(3);
  const std::vector<Gaussian<D>> gaussians = thinGaussians<D>(random, 60);
  for (const GaussianDistance distance : kDistances) {
    for (const Gaussian<D>& p : gaussians) {
      // With variances up to 1e8 times as large as others, 1e-8 nat is the rounding error of the divergences.
      EXPECT_NEAR(gaussianDistance(p, p, distance), 0.0, distance == GaussianDistance::Wasserstein ? 1e-25 : 1e-7);
      for (const Gaussian<D>& q : gaussians) {
        if (&p == &q) continue;
        const double there = gaussianDistance(p, q, distance), back = gaussianDistance(q, p, distance);
        EXPECT_GT(there, 1e-4);
        if (distance != GaussianDistance::KL) {
          ASSERT_NEAR(there, back, 1e-7 * there) << static_cast<int>(distance);
        }
      }
    }
    Gaussian<D> moved = gaussians.front(), wider = gaussians.front();
    moved.mean(0) += 1e-3;
    wider.cov *= 1.01;
    EXPECT_GT(gaussianDistance(gaussians.front(), moved, distance), 0.0);
    EXPECT_GT(gaussianDistance(gaussians.front(), wider, distance), 0.0);
  }
}
TEST(GaussianDistance, IsZeroOnlyIfEqualAndSymmetricIfItSaysSoIn2D) {
  expectZeroOnlyIfEqualAndSymmetric<2>();
}
TEST(GaussianDistance, IsZeroOnlyIfEqualAndSymmetricIfItSaysSoIn3D) {
  expectZeroOnlyIfEqualAndSymmetric<3>();
}

template <int D>
Gaussian<D> mapped(const Gaussian<D>& gaussian, const Eigen::Matrix<double, D, D>& linear, const Vector<D>& shift) {
  return {linear * gaussian.mean + shift, linear * gaussian.cov * linear.transpose(), gaussian.weight};
}

TEST(GaussianDistance, KeepsItsValueUnderRigidMotionsAndButForWassersteinUnderAffineMaps) {
  Random random(4);
  const std::vector<Gaussian<3>> gaussians = randomGaussians<3>(random, 40);
  const Eigen::Matrix3d rotation = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
  Eigen::Matrix3d affine;
  affine << 2.0, 0.3, -0.4, 0.1, 0.5, 0.2, 0.0, -0.6, 1.5;
  const Vector<3> shift(3.0, -2.0, 1.0);
  double change = 0.0;
  for (const GaussianDistance distance : kDistances)
    for (std::size_t i = 0; i + 1 < gaussians.size(); ++i) {
      const Gaussian<3>&p = gaussians[i], &q = gaussians[i + 1];
      const double value = gaussianDistance(p, q, distance);
      const double turned = gaussianDistance(mapped<3>(p, rotation, shift), mapped<3>(q, rotation, shift), distance);
      const double sheared = gaussianDistance(mapped<3>(p, affine, shift), mapped<3>(q, affine, shift), distance);
      EXPECT_NEAR(turned, value, 1e-10 * (1.0 + value));
      if (distance == GaussianDistance::Wasserstein)
        change = std::max(change, std::abs(sheared - value) / value);
      else
        EXPECT_NEAR(sheared, value, 1e-9 * (1.0 + value));
    }
  EXPECT_GT(change, 0.5);  // lengths count for Wasserstein
}

TEST(GaussianDistance, WassersteinIsAMetric) {
  Random random(5);
  const std::vector<Gaussian<3>> g = thinGaussians<3>(random, 25);
  const auto metres = [](const Gaussian<3>& p, const Gaussian<3>& q) { return std::sqrt(wassersteinSquared(p, q)); };
  for (const Gaussian<3>& a : g)
    for (const Gaussian<3>& b : g)
      for (const Gaussian<3>& c : g) ASSERT_LE(metres(a, c), (metres(a, b) + metres(b, c)) * (1.0 + 1e-12));
}

TEST(GaussianDistance, RefusesASingularCovariance) {
  Gaussian<3> flat = sphere(0, 1.0);
  for (const double variance : {0.0, std::nan("")}) {
    flat.cov(2, 2) = variance;
    for (const GaussianDistance distance : kDistances) {
      EXPECT_THROW(gaussianDistance(flat, sphere(0, 1.0), distance), std::domain_error);
      EXPECT_THROW(gaussianDistance(sphere(0, 1.0), flat, distance), std::domain_error);
    }
  }
  EXPECT_THROW(gaussianDistance(sphere(0, 1.0), sphere(1, 1.0), static_cast<GaussianDistance>(7)),
               std::invalid_argument);
}

}  // namespace
}  // namespace gaussmap
