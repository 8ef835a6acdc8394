// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/core/random.h"

namespace gaussmap {

/// Even sizes are stored unaligned: the alignment Eigen would choose depends on the user's -m flags,
/// and a library built without AVX could not share such a type with a program built with it.
template <int D>
inline constexpr int kStorage = D % 2 == 0 ? int(Eigen::DontAlign) : int(Eigen::AutoAlign);
template <int D>
using Vector = Eigen::Matrix<double, D, 1, kStorage<D>>;
template <int D>
using Matrix = Eigen::Matrix<double, D, D, kStorage<D>>;

/// A weighted Gaussian, the one value every stage hands to the next. D = 3 in space, D = 2 in the plane.
template <int D>
struct Gaussian {
  Vector<D> mean = Vector<D>::Zero();     ///< mu, D x 1 [m], map frame unless a function says otherwise
  Matrix<D> cov = Matrix<D>::Identity();  ///< Sigma, D x D [m^2], symmetric positive definite
  double weight = 0.0;                    ///< alpha > 0, how many points it stands for
};

/// KL(p || q) [nat] = (tr(Sq^-1 Sp) + (mq-mp)' Sq^-1 (mq-mp) - D + ln |Sq|/|Sp|) / 2, Yguel 2009 eq. (8).
/// Never negative. Not symmetric, not a metric. Throws std::domain_error if a covariance is not positive definite.
template <int D>
double klDivergence(const Gaussian<D>& p, const Gaussian<D>& q);

/// Squared Mahalanobis distance (x-mu)' Sigma^-1 (x-mu), no unit. Throws std::domain_error as above.
template <int D>
double mahalanobisSquared(const Vector<D>& point, const Gaussian<D>& gaussian);

/// ln N(point; mu, Sigma), the normalised density [1/m^D], weight not counted. Throws std::domain_error as above.
template <int D>
double logDensity(const Vector<D>& point, const Gaussian<D>& gaussian);

/// ln det Sigma. Throws std::domain_error as above.
template <int D>
double logDeterminant(const Matrix<D>& cov);

/// Moment matching: the mixture's total weight, mean and covariance in one Gaussian, Yguel 2009 eqs. (9), (10).
/// Summed about the mean, so that far means lose nothing. Throws std::invalid_argument without a positive weight.
template <int D>
Gaussian<D> merge(const std::vector<Gaussian<D>>& parts);

/// The axes of a Gaussian's ellipsoid.
template <int D>
struct PrincipalAxes {
  Vector<D> variances;   ///< eigenvalues [m^2], ascending
  Matrix<D> directions;  ///< unit eigenvectors, one a column, in the order of the eigenvalues

  /// Direction of least variance: the surface normal of a flat cluster (sign arbitrary but repeatable).
  Vector<D> normal() const { return directions.col(0); }
  /// 1 for an ideal plane (a line in 2-D), 0 for a sphere: (s1 - s0) / s_max, s = standard deviations ascending.
  double flatness() const;
  /// 1 for an ideal line, 0 for a disc or sphere: (s_max - s_next) / s_max.
  double linearity() const;
};

/// Eigen-decomposition of the covariance. Throws std::domain_error if it is not finite.
template <int D>
PrincipalAxes<D> principalAxes(const Gaussian<D>& gaussian);

/// Draws points from one Gaussian; the factorisation is done once.
template <int D>
class GaussianSampler {
 public:
  /// Throws std::domain_error if the covariance is not positive definite.
  explicit GaussianSampler(const Gaussian<D>& gaussian);
  /// One point, map frame.
  Vector<D> operator()(Random& random) const { return fromStandard(standard(random)); }
  /// D independent standard normals: |z| is the Mahalanobis distance of fromStandard(z).
  static Vector<D> standard(Random& random);
  Vector<D> fromStandard(const Vector<D>& z) const { return mean_ + factor_ * z; }

 private:
  Vector<D> mean_;
  Matrix<D> factor_;  // lower Cholesky factor
};

}  // namespace gaussmap
