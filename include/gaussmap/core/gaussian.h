// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>
#include "gaussmap/version.h"

namespace gaussmap {

/// Generates pseudo-random numbers from a seed (SplitMix64).
///
/// The numbers are the same with every standard library, unlike those of the standard distributions. Construction is
/// cheap, so each cell or cluster can have its own generator.
class GAUSSMAP_API Random {
 public:
  /// Starts the sequence that belongs to `seed`.
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Returns the generator of one part of a job, for example of one cell. The generators of the parts do not affect
  /// each other, so the parts can run in any order.
  static Random forPart(std::uint64_t seed, std::uint64_t part) {
    Random mixed(seed ^ (part * 0x9E3779B97F4A7C15ull));
    return Random(mixed.bits() + part);
  }

  /// Returns 64 random bits.
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }

  /// Returns a uniform random number in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }

  /// Returns a uniform random integer from 0 to n - 1, for n from 1 to 2^32. Every probability differs from 1 / n by
  /// less than 2^-64.
  std::uint64_t below(std::uint64_t n) {
    const std::uint64_t high = bits() >> 32, low = bits() >> 32;
    return ((high * n) + ((low * n) >> 32)) >> 32;
  }

  /// Returns a standard normal random number (Marsaglia's polar method).
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

/// Eigen's storage option of Vector and Matrix. Even sizes are stored unaligned. With Eigen's default, their alignment
/// would depend on the -m flags of the compiler. A library built without AVX and a program built with AVX could then
/// not exchange these types.
template <int D>
inline constexpr int kStorage = D % 2 == 0 ? int(Eigen::DontAlign) : int(Eigen::AutoAlign);
/// A column vector of D doubles.
template <int D>
using Vector = Eigen::Matrix<double, D, 1, kStorage<D>>;
/// A D x D matrix of doubles.
template <int D>
using Matrix = Eigen::Matrix<double, D, D, kStorage<D>>;

/// A weighted Gaussian, the common data type of all parts of the library. D = 3 in space, D = 2 in the plane.
template <int D>
struct GAUSSMAP_API Gaussian {
  Vector<D> mean = Vector<D>::Zero();     ///< mu, D x 1 [m], map frame unless a function says otherwise
  Matrix<D> cov = Matrix<D>::Identity();  ///< Sigma, D x D [m^2], symmetric positive definite
  double weight = 0.0;                    ///< alpha > 0, number of points that the Gaussian represents
};

/// Returns the Kullback-Leibler divergence of p from q [nat], Yguel 2009 eq. (8).
///
/// `KL(p || q) = (tr(Sq^-1 Sp) + (mq-mp)' Sq^-1 (mq-mp) - D + ln |Sq|/|Sp|) / 2`, with m = mean and S = covariance.
/// The divergence is never negative. It is not symmetric and not a metric.
/// Throws std::domain_error if a covariance is not positive definite.
template <int D>
GAUSSMAP_API double klDivergence(const Gaussian<D>& p, const Gaussian<D>& q);

/// Returns the symmetric KL divergence J [nat] (Jeffreys 1946): `J(p, q) = KL(p || q) + KL(q || p)`.
///
/// It is the sum of both divergences, not their mean. It is symmetric, but it is not a metric.
/// Throws std::domain_error if a covariance is not positive definite.
template <int D>
GAUSSMAP_API double symmetricKLDivergence(const Gaussian<D>& p, const Gaussian<D>& q);

/// Returns the Bhattacharyya distance [nat] (Bhattacharyya 1943): the negative logarithm of the overlap of two
/// densities, `-ln integral sqrt(p(x) q(x)) dx`.
///
/// `B(p, q) = (mq-mp)' S^-1 (mq-mp) / 8 + ln(|S| / sqrt(|Sp| |Sq|)) / 2`, with `S = (Sp + Sq) / 2`. The distance is
/// symmetric, but it is not a metric. Throws std::domain_error if a covariance is not positive definite.
template <int D>
GAUSSMAP_API double bhattacharyyaDistance(const Gaussian<D>& p, const Gaussian<D>& q);

/// Returns the squared 2-Wasserstein distance [m^2] (Olkin and Pukelsheim 1982; Givens and Shortt 1984): the minimum
/// mean squared distance over which the mass of p must be moved to turn p into q.
///
/// `W^2(p, q) = |mq-mp|^2 + tr Sp + tr Sq - 2 tr((Sp^1/2 Sq Sp^1/2)^1/2)`. Its square root is a metric. The
/// function computes the part of the covariances as a sum of squares, not as this difference of traces. The result is
/// therefore accurate to about 1e-15 also for thin Gaussians. Throws std::domain_error if a covariance is not positive
/// definite.
template <int D>
GAUSSMAP_API double wassersteinSquared(const Gaussian<D>& p, const Gaussian<D>& q);

/// A distance between two Gaussians. Every distance is 0 if the Gaussians are equal. The weights are not used.
enum class GaussianDistance {
  KL,             ///< klDivergence() [nat], Yguel 2009 eq. (8); not symmetric
  SymmetricKL,    ///< symmetricKLDivergence() [nat], Jeffreys 1946
  Bhattacharyya,  ///< bhattacharyyaDistance() [nat], Bhattacharyya 1943
  /// wassersteinSquared() [m^2], Olkin and Pukelsheim 1982. Only this distance depends on lengths in metres: it changes
  /// if space is stretched. The other distances keep their values under every invertible affine map.
  Wasserstein,
};

/// Returns the selected distance from p to q, in the unit of that distance (see GaussianDistance). Throws like the
/// function of the distance, and std::invalid_argument if `distance` is not a value of the enumeration.
template <int D>
GAUSSMAP_API double gaussianDistance(const Gaussian<D>& p, const Gaussian<D>& q, GaussianDistance distance);

/// Returns the squared Mahalanobis distance `(x-mu)' Sigma^-1 (x-mu)` of a point x from a Gaussian, without unit.
/// Throws std::domain_error if the covariance is not positive definite.
template <int D>
GAUSSMAP_API double mahalanobisSquared(const Vector<D>& point, const Gaussian<D>& gaussian);

/// Returns the logarithm of the normalised density, `ln N(point; mu, Sigma)`, with the density in 1/m^D. The weight is
/// not used. Throws std::domain_error if the covariance is not positive definite.
template <int D>
GAUSSMAP_API double logDensity(const Vector<D>& point, const Gaussian<D>& gaussian);

/// Returns `ln det Sigma` of a covariance Sigma [m^2]. Throws std::domain_error if it is not positive definite.
template <int D>
GAUSSMAP_API double logDeterminant(const Matrix<D>& cov);

/// Returns the moment match of a mixture: one Gaussian with the mixture's total weight, mean and covariance,
/// Yguel 2009 eqs. (9), (10).
///
/// The sums are relative to the first mean, so they lose no precision far from the origin.
/// Throws std::invalid_argument if the total weight is not positive.
template <int D>
GAUSSMAP_API Gaussian<D> merge(const std::vector<Gaussian<D>>& parts);

/// The principal axes of a Gaussian's covariance ellipsoid.
template <int D>
struct GAUSSMAP_API PrincipalAxes {
  Vector<D> variances;   ///< eigenvalues [m^2], ascending
  Matrix<D> directions;  ///< unit eigenvectors, one per column, in the order of the eigenvalues

  /// Returns the direction of smallest variance: the surface normal of a flat cluster. Its sign is arbitrary, but the
  /// same input gives the same sign.
  Vector<D> normal() const { return directions.col(0); }
  /// Returns `(s1 - s0) / s_max`, with s = standard deviations in ascending order. In 3-D, the value is 1 for a round
  /// disc without thickness, and 0 for a line or a sphere. In 2-D, it is 1 for a line and 0 for a circle.
  double flatness() const;
  /// Returns `(s_max - s_next) / s_max`, with the two largest standard deviations s_max and s_next. The value is 1 for
  /// a line, and 0 for a round disc or a sphere.
  double linearity() const;
};

/// Returns the eigendecomposition of a Gaussian's covariance. Throws std::domain_error if the covariance is not finite.
template <int D>
GAUSSMAP_API PrincipalAxes<D> principalAxes(const Gaussian<D>& gaussian);

/// Draws random points from one Gaussian. The covariance is factorised once, in the constructor.
template <int D>
class GAUSSMAP_API GaussianSampler {
 public:
  /// Factorises the covariance. Throws std::domain_error if the covariance is not positive definite.
  explicit GaussianSampler(const Gaussian<D>& gaussian);
  /// Returns one random point, in the frame of the Gaussian [m].
  Vector<D> operator()(Random& random) const { return fromStandard(standard(random)); }
  /// Returns D independent standard normal numbers z. |z| is the Mahalanobis distance of the point fromStandard(z).
  static Vector<D> standard(Random& random);
  /// Returns the point at the standardised coordinates `z`, in the frame of the Gaussian [m].
  Vector<D> fromStandard(const Vector<D>& z) const { return mean_ + factor_ * z; }

 private:
  Vector<D> mean_;
  Matrix<D> factor_;  // lower Cholesky factor
};

}  // namespace gaussmap
