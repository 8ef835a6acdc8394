// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/gaussian.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace gaussmap {
namespace {

Gaussian<3> sphere(double x, double sigma, double weight = 1.0) {
  return {{x, 0, 0}, sigma * sigma * Eigen::Matrix3d::Identity(), weight};
}

template <int D>
Gaussian<D> randomGaussian(Random& random) {
  Gaussian<D> gaussian;
  Matrix<D> factor;
  for (int row = 0; row < D; ++row) {
    gaussian.mean(row) = random.normal();
    for (int column = 0; column < D; ++column) factor(row, column) = random.normal();
  }
  gaussian.cov = factor * factor.transpose() + 0.01 * Matrix<D>::Identity();
  gaussian.weight = 0.1 + random.uniform();
  return gaussian;
}

TEST(KLDivergence, MatchesTheClosedFormOfTwoSpheres) {  // equal sigma: d^2 / (2 sigma^2) = 4 / 0.5
  EXPECT_NEAR(klDivergence(sphere(0, 0.5), sphere(2, 0.5)), 8.0, 1e-12);
}

TEST(KLDivergence, MatchesTheClosedFormOfConcentricSpheres) {  // D/2 (r^2 - 1 - ln r^2) with r = sp / sq = 2
  EXPECT_NEAR(klDivergence(sphere(0, 1.0), sphere(0, 0.5)), 1.5 * (4.0 - 1.0 - std::log(4.0)), 1e-12);
}

TEST(KLDivergence, IsZeroForEqualAndNotSymmetric) {
  const Gaussian<3> p = sphere(0, 1.0), q = sphere(1, 0.3);
  EXPECT_NEAR(klDivergence(p, p), 0.0, 1e-14);
  EXPECT_GT(std::abs(klDivergence(p, q) - klDivergence(q, p)), 1.0);
}

template <int D>
void expectFormulaOfThePaper() {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Gaussian<D> p = randomGaussian<D>(random), q = randomGaussian<D>(random);
    const Matrix<D> inverse = q.cov.inverse();
    const Vector<D> difference = q.mean - p.mean;
    const double expected = 0.5 * (difference.dot(inverse * difference) + (p.cov * inverse).trace() - D +
                                   std::log(q.cov.determinant() / p.cov.determinant()));
    EXPECT_NEAR(klDivergence(p, q), expected, 1e-8 * (1.0 + expected));
    EXPECT_GE(klDivergence(p, q), 0.0);
  }
}
TEST(KLDivergence, IsTheFormulaOfThePaperIn2D) {
  expectFormulaOfThePaper<2>();
}
TEST(KLDivergence, IsTheFormulaOfThePaperIn3D) {
  expectFormulaOfThePaper<3>();
}

TEST(KLDivergence, RefusesASingularCovariance) {
  Gaussian<3> flat = sphere(0, 1.0);
  flat.cov(2, 2) = 0.0;
  EXPECT_THROW(klDivergence(flat, sphere(0, 1.0)), std::domain_error);
  EXPECT_THROW(klDivergence(sphere(0, 1.0), flat), std::domain_error);
  flat.cov(2, 2) = std::nan("");
  EXPECT_THROW(klDivergence(sphere(0, 1.0), flat), std::domain_error);
}

TEST(Mahalanobis, CountsStandardDeviations) {
  EXPECT_NEAR(mahalanobisSquared<3>({0, 1.5, 0}, sphere(0, 0.5)), 9.0, 1e-12);
}

TEST(LogDensity, OfAPlanarGaussianIntegratesToOne) {
  const Gaussian<2> gaussian{{0.3, -0.2}, (Eigen::Matrix2d() << 0.5, 0.2, 0.2, 0.3).finished(), 7.0};
  double integral = 0.0;
  for (double x = -5; x < 5; x += 0.05)
    for (double y = -5; y < 5; y += 0.05) integral += std::exp(logDensity<2>({x, y}, gaussian)) * 0.05 * 0.05;
  EXPECT_NEAR(integral, 1.0, 1e-6);
}

TEST(Merge, AddsTheSpreadOfTheMeans) {  // means 2 m apart: + 1 m^2 along x only
  const Gaussian<3> merged = merge<3>({sphere(-1, 0.1), sphere(1, 0.1)});
  EXPECT_NEAR(merged.cov(0, 0), 1.01, 1e-12);
  EXPECT_NEAR(merged.cov(1, 1), 0.01, 1e-12);
  EXPECT_NEAR(merged.mean.norm(), 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(merged.weight, 2.0);
}

TEST(Merge, OfMergedPartsIsTheMergeOfAll) {
  Random random(2);
  std::vector<Gaussian<3>> all;
  for (int i = 0; i < 20; ++i) all.push_back(randomGaussian<3>(random));
  const Gaussian<3> left = merge<3>({all.begin(), all.begin() + 7});
  const Gaussian<3> right = merge<3>({all.begin() + 7, all.end()});
  const Gaussian<3> once = merge<3>(all), twice = merge<3>({left, right});
  EXPECT_NEAR((once.mean - twice.mean).norm(), 0.0, 1e-13);
  EXPECT_NEAR((once.cov - twice.cov).norm(), 0.0, 1e-12);
}

TEST(Merge, LosesNothingFarFromTheOrigin) {
  std::vector<Gaussian<3>> parts = {sphere(-1, 0.1), sphere(1, 0.1)};
  for (Gaussian<3>& part : parts) part.mean += Eigen::Vector3d(1e7, -1e7, 1e7);
  const Gaussian<3> merged = merge<3>(parts);
  EXPECT_NEAR(merged.cov(0, 0), 1.01, 1e-12);
  EXPECT_NEAR(merged.cov(1, 1), 0.01, 1e-12);
}

TEST(Merge, OfNothingIsRefused) {
  EXPECT_THROW(merge<3>({}), std::invalid_argument);
}

TEST(PrincipalAxes, TellPlanesLinesAndSpheresApart) {
  const auto withDeviations = [](double x, double y, double z) {
    return principalAxes<3>({Eigen::Vector3d::Zero(), Eigen::Vector3d(x * x, y * y, z * z).asDiagonal(), 1.0});
  };
  const PrincipalAxes<3> plane = withDeviations(1.0, 1.0, 0.01), line = withDeviations(0.01, 1.0, 0.01);
  EXPECT_NEAR(plane.flatness(), 0.99, 1e-12);
  EXPECT_NEAR(plane.linearity(), 0.0, 1e-12);
  EXPECT_NEAR(std::abs(plane.normal().z()), 1.0, 1e-12);
  EXPECT_NEAR(line.linearity(), 0.99, 1e-12);
  EXPECT_NEAR(line.flatness(), 0.0, 1e-12);
  EXPECT_NEAR(withDeviations(0.3, 0.3, 0.3).flatness(), 0.0, 1e-12);
  EXPECT_NEAR(withDeviations(0.3, 0.3, 0.3).linearity(), 0.0, 1e-12);
}

TEST(Sampler, ReproducesMeanAndCovariance) {
  Random random(3);
  const Gaussian<3> gaussian = randomGaussian<3>(random);
  const GaussianSampler<3> sampler(gaussian);
  const int n = 200000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d offset = sampler(random) - gaussian.mean;
    sum += offset;
    products += offset * offset.transpose();
  }
  const double scale = gaussian.cov.norm();
  EXPECT_LT((sum / n).norm(), 0.01 * std::sqrt(scale));
  EXPECT_LT((products / n - gaussian.cov).norm(), 0.02 * scale);
}

TEST(RandomNumbers, OfDifferentPartsDifferAndRepeat) {
  EXPECT_NE(Random::forPart(1, 2).bits(), Random::forPart(1, 3).bits());
  EXPECT_NE(Random::forPart(1, 2).bits(), Random::forPart(2, 2).bits());
  EXPECT_EQ(Random::forPart(1, 2).bits(), Random::forPart(1, 2).bits());
}

TEST(RandomNumbers, BelowNCoverAllValuesEvenly) {
  Random random(4);
  std::vector<int> counts(7, 0);
  for (int i = 0; i < 70000; ++i) ++counts[random.below(7)];
  for (int count : counts) EXPECT_NEAR(count, 10000, 400);
}

}  // namespace
}  // namespace gaussmap
