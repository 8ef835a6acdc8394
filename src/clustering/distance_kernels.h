// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gaussmap/core/gaussian.h"
#include "small_cholesky.h"

// The distances of GaussianDistance in the form in which k-means evaluates them. A kernel writes an input Gaussian z
// and a cluster centre w as columns of kFeatures numbers x and y. at() computes their distance, without the part
// constant(z). `x` points to the first number of z; the numbers are `stride` apart. For a distance above `limit`, at()
// can return any other number above `limit`.
namespace gaussmap::detail {

/// Writes the upper triangle of a symmetric matrix to `numbers` from `slot` on. Moves `slot`.
template <int D, typename Numbers>
void writeUpperTriangle(const Matrix<D>& matrix, Numbers& numbers, int& slot) {
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) numbers(slot++) = matrix(i, j);
}

/// The distance x . y, for distances that are linear in numbers of z: all distances are one matrix product.
template <int F>
struct LinearKernel {
  static constexpr bool kIsLinear = true;
  static constexpr int kFeatures = F;

  static double at(const double* x, Eigen::Index stride, const Eigen::Matrix<double, F, 1>& y, double /*limit*/) {
    double distance = y(0);  // x_0 is 1
    for (int f = 1; f < F; ++f) distance += y(f) * x[f * stride];
    return distance;
  }
};

/// The KL divergence, eq. (8), with x = [1, mu, upper triangle of Sigma + mu mu'] and P = Sigma_w^-1:
///   KL(z || w) = x . y - (ln |Sigma_z| + D) / 2,
///   y = [(mu_w' P mu_w + ln |Sigma_w|) / 2, -P mu_w, P_ii / 2 and P_ij].
template <int D>
struct KLKernel : LinearKernel<1 + D + D*(D + 1) / 2> {
  template <typename Numbers>
  static void writeInput(const Vector<D>& mean, const Matrix<D>& cov, const SmallCholesky<D>& /*factor*/, Numbers&& x) {
    x(0) = 1.0;
    int slot = 1;
    for (int i = 0; i < D; ++i) x(slot++) = mean(i);
    for (int i = 0; i < D; ++i)
      for (int j = i; j < D; ++j) x(slot++) = cov(i, j) + mean(i) * mean(j);
  }

  template <typename Numbers>
  static void writeCentre(const Gaussian<D>& w, const SmallCholesky<D>& factor, Numbers&& y) {
    const Matrix<D> inverse = factor.inverse();
    const Vector<D> information = inverse * w.mean;
    y(0) = 0.5 * (w.mean.dot(information) + factor.logDeterminant());
    int slot = 1;
    for (int i = 0; i < D; ++i) y(slot++) = -information(i);
    for (int i = 0; i < D; ++i)
      for (int j = i; j < D; ++j) y(slot++) = i == j ? 0.5 * inverse(i, i) : inverse(i, j);
  }

  static double constant(const Vector<D>& /*mean*/, const SmallCholesky<D>& factor) {
    return -0.5 * (factor.logDeterminant() + D);
  }
};

/// The symmetric KL divergence. The logarithms cancel. KL(w || z) is linear in Q mu and Q, with Q = Sigma_z^-1:
///   J(z, w) = x . y + mu' Q mu / 2 - D,   x = [1, mu, upper triangle of Sigma + mu mu', Q mu, upper triangle of Q],
///   y = [mu_w' P mu_w / 2, -P mu_w, P_ii / 2 and P_ij, -mu_w, B_ii / 2 and B_ij],   B = Sigma_w + mu_w mu_w'.
template <int D>
struct SymmetricKLKernel : LinearKernel<1 + D*(D + 3)> {
  template <typename Numbers>
  static void writeInput(const Vector<D>& mean, const Matrix<D>& cov, const SmallCholesky<D>& factor, Numbers&& x) {
    const Matrix<D> inverse = factor.inverse();
    const Vector<D> information = inverse * mean;
    x(0) = 1.0;
    int slot = 1;
    for (int i = 0; i < D; ++i) x(slot++) = mean(i);
    writeUpperTriangle<D>(cov + mean * mean.transpose(), x, slot);
    for (int i = 0; i < D; ++i) x(slot++) = information(i);
    writeUpperTriangle<D>(inverse, x, slot);
  }

  template <typename Numbers>
  static void writeCentre(const Gaussian<D>& w, const SmallCholesky<D>& factor, Numbers&& y) {
    Matrix<D> inverse = factor.inverse(), moment = w.cov + w.mean * w.mean.transpose();
    const Vector<D> information = inverse * w.mean;
    inverse.diagonal() *= 0.5;  // each element outside of the diagonal counts twice
    moment.diagonal() *= 0.5;
    y(0) = 0.5 * w.mean.dot(information);
    int slot = 1;
    for (int i = 0; i < D; ++i) y(slot++) = -information(i);
    writeUpperTriangle<D>(inverse, y, slot);
    for (int i = 0; i < D; ++i) y(slot++) = -w.mean(i);
    writeUpperTriangle<D>(moment, y, slot);
  }

  static double constant(const Vector<D>& mean, const SmallCholesky<D>& factor) {
    return 0.5 * (factor.whitening * mean).squaredNorm() - D;
  }
};

/// A distance that has the same numbers for z and w: the mean, a triangle of a matrix and one more number.
template <int D>
struct PairwiseKernel {
  static constexpr bool kIsLinear = false;
  static constexpr int kMatrix = D;  // place of the first number of the triangle
  static constexpr int kLast = D + D * (D + 1) / 2;
  static constexpr int kFeatures = kLast + 1;
  using Numbers = Eigen::Matrix<double, kFeatures, 1>;

  static double constant(const Vector<D>& /*mean*/, const SmallCholesky<D>& /*factor*/) { return 0.0; }

 protected:
  static Vector<D> difference(const double* x, Eigen::Index stride, const Numbers& y) {
    Vector<D> difference;
    for (int i = 0; i < D; ++i) difference(i) = x[i * stride] - y(i);
    return difference;
  }
};

/// The Bhattacharyya distance. Numbers: mean, covariance, ln |Sigma| / 4.
template <int D>
struct BhattacharyyaKernel : PairwiseKernel<D> {
  using Base = PairwiseKernel<D>;

  template <typename Row>
  static void writeInput(const Vector<D>& mean, const Matrix<D>& cov, const SmallCholesky<D>& factor, Row&& x) {
    int slot = 0;
    for (int i = 0; i < D; ++i) x(slot++) = mean(i);
    writeUpperTriangle<D>(cov, x, slot);
    x(slot) = 0.25 * factor.logDeterminant();
  }
  template <typename Column>
  static void writeCentre(const Gaussian<D>& w, const SmallCholesky<D>& factor, Column&& y) {
    writeInput(w.mean, w.cov, factor, y);
  }

  static double at(const double* x, Eigen::Index stride, const typename Base::Numbers& y, double /*limit*/) {
    Matrix<D> average;
    int slot = Base::kMatrix;
    for (int i = 0; i < D; ++i)
      for (int j = i; j < D; ++j, ++slot) average(j, i) = 0.5 * (x[slot * stride] + y(slot));
    const SmallCholesky<D> factor(average);
    const double mahalanobis =
        (factor.whitening.template triangularView<Eigen::Lower>() * Base::difference(x, stride, y)).squaredNorm();
    return 0.125 * mahalanobis + 0.5 * factor.logDeterminant() - x[Base::kLast * stride] - y(Base::kLast);
  }
};

/// Returns the sum of the singular values s_i of a matrix whose determinant is not negative.
inline double nuclearNorm(const Matrix<2>& matrix, double determinant) {
  return std::sqrt(matrix.squaredNorm() + 2.0 * determinant);  // (s_1 + s_2)^2
}

/// The same in 3-D. With n = sum of s_i and q = s_1 s_2 + s_1 s_3 + s_2 s_3:
///   n^2 = sum of s_i^2 + 2 q,   q^2 = sum of s_i^2 s_j^2 + 2 n det,
/// where the two sums are the squared norms of the matrix and of its cofactors. All terms are positive, so no digits
/// are lost. Newton's method finds n: the error is squared in each step, and less than a tenth of it is left anyway.
inline double nuclearNorm(const Matrix<3>& matrix, double determinant) {
  const double squares = matrix.squaredNorm();
  const double products = matrix.col(0).cross(matrix.col(1)).squaredNorm() +
                          matrix.col(0).cross(matrix.col(2)).squaredNorm() +
                          matrix.col(1).cross(matrix.col(2)).squaredNorm();
  double norm = std::sqrt(squares);
  for (int step = 0; step < 10; ++step) {
    const double q = std::sqrt(products + 2.0 * determinant * norm);
    const double next = std::sqrt(squares + 2.0 * q);
    if (!(q > 0.0)) return next;
    const double change = (next - norm) / (1.0 - determinant / (next * q));
    norm += change;
    if (std::abs(change) <= 1e-8 * norm) break;
  }
  return norm;
}

/// The squared 2-Wasserstein distance. Numbers: mean, lower Cholesky factor L by columns, r = sqrt(tr Sigma). The trace
/// n of (S_w^1/2 S_z S_w^1/2)^1/2 is the sum of the singular values of L_w' L_z. It is at most r_z r_w. So
///   W^2 = |mu_z - mu_w|^2 + (r_z - r_w)^2 + 2 (r_z r_w - n),
/// and the first two terms show without n that most centres are not the nearest one.
template <int D>
struct WassersteinKernel : PairwiseKernel<D> {
  using Base = PairwiseKernel<D>;

  template <typename Row>
  static void writeInput(const Vector<D>& mean, const Matrix<D>& cov, const SmallCholesky<D>& factor, Row&& x) {
    int slot = 0;
    for (int i = 0; i < D; ++i) x(slot++) = mean(i);
    for (int j = 0; j < D; ++j)
      for (int i = j; i < D; ++i) x(slot++) = factor.lower(i, j);
    x(slot) = std::sqrt(cov.trace());
  }
  template <typename Column>
  static void writeCentre(const Gaussian<D>& w, const SmallCholesky<D>& factor, Column&& y) {
    writeInput(w.mean, w.cov, factor, y);
  }

  static double at(const double* x, Eigen::Index stride, const typename Base::Numbers& y, double limit) {
    const double z_root = x[Base::kLast * stride], w_root = y(Base::kLast);
    const double least = Base::difference(x, stride, y).squaredNorm() + (z_root - w_root) * (z_root - w_root);
    if (least > limit) return least;
    Matrix<D> z = Matrix<D>::Zero(), w = Matrix<D>::Zero();
    int slot = Base::kMatrix;
    double determinant = 1.0;
    for (int j = 0; j < D; ++j)
      for (int i = j; i < D; ++i, ++slot) {
        z(i, j) = x[slot * stride];
        w(i, j) = y(slot);
        if (i == j) determinant *= z(i, i) * w(i, i);
      }
    const Matrix<D> product = w.transpose().lazyProduct(z);
    return least + 2.0 * std::max(0.0, z_root * w_root - nuclearNorm(product, determinant));
  }
};

}  // namespace gaussmap::detail
