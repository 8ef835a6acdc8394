// SPDX-License-Identifier: BSD-3-Clause
#include "registration/observability.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace gaussmap::detail {
namespace {

template <int N>
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, N, N>;
template <int N>
using Axes = Eigen::Matrix<double, N, Eigen::Dynamic, 0, N, N>;

/// Returns the change of the pose per scaled unit.
template <int N>
Eigen::Matrix<double, N, 1> unitsOf(double range) {
  constexpr int kRotations = N == 3 ? 1 : 3;
  Eigen::Matrix<double, N, 1> units = Eigen::Matrix<double, N, 1>::Ones();
  units.template tail<kRotations>().setConstant(1.0 / range);
  return units;
}

template <int N>
Eigen::Matrix<double, N, 1> weakest(const Eigen::Matrix<double, N, N>& information, double range) {
  const Eigen::Matrix<double, N, 1> units = unitsOf<N>(range);
  const Eigen::Matrix<double, N, N> scaled = units.asDiagonal() * information * units.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>>(scaled).eigenvectors().col(0);
}

}  // namespace

template <int N>
Eigen::Matrix<double, N, N> HeldPoseDirections<N>::scaled(const PoseMatrix& matrix) const {
  const PoseVector units = unitsOf<N>(range_);
  return units.asDiagonal() * matrix * units.asDiagonal();
}

template <int N>
bool HeldPoseDirections<N>::hold(const PoseMatrix& information, double limit) {
  if (count_ == N) return false;
  const PoseMatrix all = scaled(information);
  const Eigen::SelfAdjointEigenSolver<Square<N>> solver(free().transpose() * all * free());
  const double most = solver.eigenvalues().maxCoeff();
  Eigen::Index weak = 0;
  while (weak < N - count_ && !(solver.eigenvalues()[weak] > limit * most)) ++weak;
  const Axes<N> turned = free() * solver.eigenvectors();
  basis_.rightCols(N - count_) = turned;
  count_ += weak;
  return weak > 0;
}

template <int N>
Eigen::Matrix<double, N, 1> HeldPoseDirections<N>::step(const PoseMatrix& matrix, const PoseVector& gradient) const {
  if (count_ == 0) return -matrix.ldlt().solve(gradient);
  if (count_ == N) return PoseVector::Zero();
  const PoseVector units = unitsOf<N>(range_);
  const Square<N> part = free().transpose() * scaled(matrix) * free();
  return -units.cwiseProduct(free() * part.ldlt().solve(free().transpose() * units.cwiseProduct(gradient)));
}

template <int N>
Eigen::Matrix<double, N, N> HeldPoseDirections<N>::covarianceOf(const PoseMatrix& information) const {
  PoseMatrix covariance = range_ * range_ * held() * held().transpose();
  if (count_ < N) {
    const Eigen::SelfAdjointEigenSolver<Square<N>> solver(free().transpose() * scaled(information) * free());
    // Without a lower limit, rounding could make an eigenvalue zero or negative.
    const Eigen::VectorXd told = solver.eigenvalues().cwiseMax(1e-12 * solver.eigenvalues().maxCoeff());
    const Axes<N> axes = free() * solver.eigenvectors();
    covariance += axes * told.cwiseInverse().asDiagonal() * axes.transpose();
  }
  covariance = scaled(covariance);
  return 0.5 * (covariance + covariance.transpose());
}

template class HeldPoseDirections<3>;
template class HeldPoseDirections<6>;

PoseDirection leastObservable(const NormalEquations::Matrix6& information, double range) {
  return weakest<6>(information, range);
}

Eigen::Vector3d leastObservable(const Eigen::Matrix3d& information, double range) {
  return weakest<3>(information, range);
}

}  // namespace gaussmap::detail
