// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// Cholesky factorisation of one small covariance, unrolled by the compiler. K-means factorises one matrix per input
/// Gaussian and per cluster centre. Eigen's solvers spend most of such a call on choosing their method.
template <int D>
struct SmallCholesky {
  Matrix<D> lower = Matrix<D>::Zero();      ///< L, with L L' = Sigma
  Matrix<D> whitening = Matrix<D>::Zero();  ///< L^-1, lower triangle: |L^-1 (x - mu)| is the Mahalanobis distance
  double root_determinant = 1.0;            ///< sqrt det Sigma
  bool positive = true;                     ///< false: not positive definite or not finite; other members are invalid

  /// Factorises `cov`, of which only the lower triangle is read.
  explicit SmallCholesky(const Matrix<D>& cov) {
    for (int j = 0; j < D; ++j) {
      double pivot = cov(j, j);
      for (int m = 0; m < j; ++m) pivot -= lower(j, m) * lower(j, m);
      if (!(pivot > 0.0)) positive = false;
      lower(j, j) = std::sqrt(pivot);
      for (int i = j + 1; i < D; ++i) {
        double sum = cov(i, j);
        for (int m = 0; m < j; ++m) sum -= lower(i, m) * lower(j, m);
        lower(i, j) = sum / lower(j, j);
      }
      root_determinant *= lower(j, j);
    }
    for (int j = 0; j < D; ++j) {
      whitening(j, j) = 1.0 / lower(j, j);
      for (int i = j + 1; i < D; ++i) {
        double sum = 0.0;
        for (int m = j; m < i; ++m) sum -= lower(i, m) * whitening(m, j);
        whitening(i, j) = sum / lower(i, i);
      }
    }
    positive = positive && root_determinant > 0.0 && std::isfinite(root_determinant) && whitening.allFinite();
  }

  double logDeterminant() const { return 2.0 * std::log(root_determinant); }
  Matrix<D> inverse() const { return whitening.transpose().lazyProduct(whitening); }
};

}  // namespace gaussmap::detail
