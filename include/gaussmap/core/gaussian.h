// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>
#include "gaussmap/version.h"

namespace gaussmap {

/// A small seeded generator (SplitMix64) that gives the same numbers with every standard library: the
/// distributions of <random> do not. Cheap to make, so that each cell or cluster can have its own.
class GAUSSMAP_API Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// A generator for one part of a job: independent of all other parts, whatever the order they run in.
  static Random forPart(std::uint64_t seed, std::uint64_t part) {
    Random mixed(seed ^ (part * 0x9E3779B97F4A7C15ull));
    return Random(mixed.bits() + part);
  }

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }

  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

  /// Uniform in {0, ..., n - 1}; n > 0. The bias of the multiplication is below n / 2^64.
  std::uint64_t below(std::uint64_t n) {
    const std::uint64_t high = bits() >> 32, low = bits() >> 32;
    return ((high * n) + ((low * n) >> 32)) >> 32;
  }

  /// Standard normal (Marsaglia's polar method).
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    double u = 0.0, v = 0.0, square = 0.0;
    do {
      u = 2.0 * uniform() - 1.0;
      v = 2.0 * uniform() - 1.0;
      square = u * u + v * v;
    } while (square >= 1.0 || square == 0.0);
    const double factor = std::sqrt(-2.0 * std::log(square) / square);
    spare_ = v * factor;
    has_spare_ = true;
    return u * factor;
  }

 private:
  std::uint64_t state_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

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
struct GAUSSMAP_API Gaussian {
  Vector<D> mean = Vector<D>::Zero();     ///< mu, D x 1 [m], map frame unless a function says otherwise
  Matrix<D> cov = Matrix<D>::Identity();  ///< Sigma, D x D [m^2], symmetric positive definite
  double weight = 0.0;                    ///< alpha > 0, how many points it stands for
};

/// KL(p || q) [nat] = (tr(Sq^-1 Sp) + (mq-mp)' Sq^-1 (mq-mp) - D + ln |Sq|/|Sp|) / 2, Yguel 2009 eq. (8).
/// Never negative. Not symmetric, not a metric. Throws std::domain_error if a covariance is not positive definite.
template <int D>
GAUSSMAP_API double klDivergence(const Gaussian<D>& p, const Gaussian<D>& q);

/// Squared Mahalanobis distance (x-mu)' Sigma^-1 (x-mu), no unit. Throws std::domain_error as above.
template <int D>
GAUSSMAP_API double mahalanobisSquared(const Vector<D>& point, const Gaussian<D>& gaussian);

/// ln N(point; mu, Sigma), the normalised density [1/m^D], weight not counted. Throws std::domain_error as above.
template <int D>
GAUSSMAP_API double logDensity(const Vector<D>& point, const Gaussian<D>& gaussian);

/// ln det Sigma. Throws std::domain_error as above.
template <int D>
GAUSSMAP_API double logDeterminant(const Matrix<D>& cov);

/// Moment matching: the mixture's total weight, mean and covariance in one Gaussian, Yguel 2009 eqs. (9), (10).
/// Summed about the mean, so that far means lose nothing. Throws std::invalid_argument without a positive weight.
template <int D>
GAUSSMAP_API Gaussian<D> merge(const std::vector<Gaussian<D>>& parts);

/// The axes of a Gaussian's ellipsoid.
template <int D>
struct GAUSSMAP_API PrincipalAxes {
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
GAUSSMAP_API PrincipalAxes<D> principalAxes(const Gaussian<D>& gaussian);

/// Draws points from one Gaussian; the factorisation is done once.
template <int D>
class GAUSSMAP_API GaussianSampler {
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
