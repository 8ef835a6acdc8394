// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/core/gaussian.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace gaussmap {
namespace {

constexpr double kLogTwoPi = 1.8378770664093454836;

template <int D>
Matrix<D> choleskyFactor(const Matrix<D>& cov) {
  const Eigen::LLT<Matrix<D>> llt(cov);
  if (!cov.allFinite() || llt.info() != Eigen::Success)
    throw std::domain_error("covariance is not positive definite; add a noise floor to its eigenvalues");
  return llt.matrixL();
}

template <int D>
double logDeterminantOfFactor(const Matrix<D>& factor) {
  return 2.0 * factor.diagonal().array().log().sum();
}

template <int D>
Vector<D> whiten(const Matrix<D>& factor, const Vector<D>& difference) {
  return factor.template triangularView<Eigen::Lower>().solve(difference);
}

}  // namespace

template <int D>
double klDivergence(const Gaussian<D>& p, const Gaussian<D>& q) {
  const Matrix<D> p_factor = choleskyFactor<D>(p.cov);
  const Matrix<D> q_factor = choleskyFactor<D>(q.cov);
  const Matrix<D> whitened = q_factor.template triangularView<Eigen::Lower>().solve(p_factor);
  const double trace = whitened.squaredNorm();
  const double mahalanobis = whiten<D>(q_factor, q.mean - p.mean).squaredNorm();
  const double log_det_ratio = logDeterminantOfFactor<D>(q_factor) - logDeterminantOfFactor<D>(p_factor);
  const double divergence = 0.5 * (trace + mahalanobis - D + log_det_ratio);  // eq. (8)
  return divergence < 0.0 ? 0.0 : divergence;                                 // rounding, if p and q are equal
}

template <int D>
double symmetricKLDivergence(const Gaussian<D>& p, const Gaussian<D>& q) {
  const Matrix<D> p_factor = choleskyFactor<D>(p.cov);
  const Matrix<D> q_factor = choleskyFactor<D>(q.cov);
  const Matrix<D> p_in_q = q_factor.template triangularView<Eigen::Lower>().solve(p_factor);
  const Matrix<D> q_in_p = p_factor.template triangularView<Eigen::Lower>().solve(q_factor);
  const double traces = p_in_q.squaredNorm() + q_in_p.squaredNorm();
  const double mahalanobis =
      whiten<D>(q_factor, q.mean - p.mean).squaredNorm() + whiten<D>(p_factor, q.mean - p.mean).squaredNorm();
  return std::max(0.0, 0.5 * (traces + mahalanobis) - D);  // the logarithms cancel
}

template <int D>
double bhattacharyyaDistance(const Gaussian<D>& p, const Gaussian<D>& q) {
  const double log_determinants =
      logDeterminantOfFactor<D>(choleskyFactor<D>(p.cov)) + logDeterminantOfFactor<D>(choleskyFactor<D>(q.cov));
  const Matrix<D> factor = choleskyFactor<D>(0.5 * (p.cov + q.cov));
  const double mahalanobis = whiten<D>(factor, q.mean - p.mean).squaredNorm();
  return std::max(0.0, 0.125 * mahalanobis + 0.5 * logDeterminantOfFactor<D>(factor) - 0.25 * log_determinants);
}

template <int D>
double wassersteinSquared(const Gaussian<D>& p, const Gaussian<D>& q) {
  const Matrix<D> p_factor = choleskyFactor<D>(p.cov);
  const Matrix<D> q_factor = choleskyFactor<D>(q.cov);
  // All factors of Sq are q_factor U with an orthogonal U. The distance of the covariances is the least |Lp - Lq U|^2.
  // The best U comes from the singular vectors of Lq' Lp. A sum of squares loses no digits, unlike the traces.
  using Plain = Eigen::Matrix<double, D, D>;
  const Plain product = q_factor.transpose() * p_factor;
  const Eigen::JacobiSVD<Plain> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Plain turn = svd.matrixU() * svd.matrixV().transpose();
  return (q.mean - p.mean).squaredNorm() + (p_factor - q_factor * turn).squaredNorm();
}

template <int D>
double gaussianDistance(const Gaussian<D>& p, const Gaussian<D>& q, GaussianDistance distance) {
  switch (distance) {
    case GaussianDistance::KL:
      return klDivergence(p, q);
    case GaussianDistance::SymmetricKL:
      return symmetricKLDivergence(p, q);
    case GaussianDistance::Bhattacharyya:
      return bhattacharyyaDistance(p, q);
    case GaussianDistance::Wasserstein:
      return wassersteinSquared(p, q);
  }
  throw std::invalid_argument("distance = " + std::to_string(static_cast<int>(distance)) +
                              ": not a value of GaussianDistance");
}

template <int D>
double mahalanobisSquared(const Vector<D>& point, const Gaussian<D>& gaussian) {
  return whiten<D>(choleskyFactor<D>(gaussian.cov), point - gaussian.mean).squaredNorm();
}

template <int D>
double logDensity(const Vector<D>& point, const Gaussian<D>& gaussian) {
  const Matrix<D> factor = choleskyFactor<D>(gaussian.cov);
  const double mahalanobis = whiten<D>(factor, point - gaussian.mean).squaredNorm();
  return -0.5 * (D * kLogTwoPi + logDeterminantOfFactor<D>(factor) + mahalanobis);
}

template <int D>
double logDeterminant(const Matrix<D>& cov) {
  return logDeterminantOfFactor<D>(choleskyFactor<D>(cov));
}

template <int D>
Gaussian<D> merge(const std::vector<Gaussian<D>>& parts) {
  Gaussian<D> merged{Vector<D>::Zero(), Matrix<D>::Zero(), 0.0};
  if (parts.size() == 1 && parts.front().weight > 0.0) return parts.front();
  const Vector<D> origin = parts.empty() ? merged.mean : parts.front().mean;
  for (const Gaussian<D>& part : parts) {
    merged.weight += part.weight;
    merged.mean += part.weight * (part.mean - origin);
  }
  if (!(merged.weight > 0.0)) throw std::invalid_argument("merge: no Gaussian has a positive weight");
  merged.mean /= merged.weight;  // eq. (9)
  for (const Gaussian<D>& part : parts) {
    const Vector<D> spread = part.mean - origin - merged.mean;
    merged.cov += part.weight * (part.cov + spread * spread.transpose());
  }
  merged.cov /= merged.weight;  // eq. (10), about the mean
  merged.mean += origin;
  return merged;
}

template <int D>
double PrincipalAxes<D>::flatness() const {
  const Vector<D> deviations = variances.cwiseMax(0.0).cwiseSqrt();
  return deviations(D - 1) > 0.0 ? (deviations(1) - deviations(0)) / deviations(D - 1) : 0.0;
}

template <int D>
double PrincipalAxes<D>::linearity() const {
  const Vector<D> deviations = variances.cwiseMax(0.0).cwiseSqrt();
  return deviations(D - 1) > 0.0 ? (deviations(D - 1) - deviations(D - 2)) / deviations(D - 1) : 0.0;
}

template <int D>
PrincipalAxes<D> principalAxes(const Gaussian<D>& gaussian) {
  if (!gaussian.cov.allFinite()) throw std::domain_error("covariance is not finite");
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> solver(gaussian.cov);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

template <int D>
GaussianSampler<D>::GaussianSampler(const Gaussian<D>& gaussian)
    : mean_(gaussian.mean), factor_(choleskyFactor<D>(gaussian.cov)) {}

template <int D>
Vector<D> GaussianSampler<D>::standard(Random& random) {
  Vector<D> z;
  for (int axis = 0; axis < D; ++axis) z(axis) = random.normal();
  return z;
}

#define GAUSSMAP_INSTANTIATE(D)                                                                  \
  template double klDivergence<D>(const Gaussian<D>&, const Gaussian<D>&);                       \
  template double symmetricKLDivergence<D>(const Gaussian<D>&, const Gaussian<D>&);              \
  template double bhattacharyyaDistance<D>(const Gaussian<D>&, const Gaussian<D>&);              \
  template double wassersteinSquared<D>(const Gaussian<D>&, const Gaussian<D>&);                 \
  template double gaussianDistance<D>(const Gaussian<D>&, const Gaussian<D>&, GaussianDistance); \
  template double mahalanobisSquared<D>(const Vector<D>&, const Gaussian<D>&);                   \
  template double logDensity<D>(const Vector<D>&, const Gaussian<D>&);                           \
  template double logDeterminant<D>(const Matrix<D>&);                                           \
  template Gaussian<D> merge<D>(const std::vector<Gaussian<(D)>>&);                              \
  template struct PrincipalAxes<D>;                                                              \
  template PrincipalAxes<D> principalAxes<D>(const Gaussian<D>&);                                \
  template class GaussianSampler<D>;
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
