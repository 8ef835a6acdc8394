// SPDX-License-Identifier: BSD-3-Clause
#include "registration/observability.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace gaussmap::detail {
namespace {

using Vector6 = NormalEquations::Vector6;
using Matrix6 = NormalEquations::Matrix6;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/// Returns the change of the pose per scaled unit.
Vector6 unitsOf(double range) {
  Vector6 units = Vector6::Ones();
  units.tail<3>().setConstant(1.0 / range);
  return units;
}

}  // namespace

Matrix6 HeldDirections::scaled(const Matrix6& matrix) const {
  const Vector6 units = unitsOf(range_);
  return units.asDiagonal() * matrix * units.asDiagonal();
}

bool HeldDirections::hold(const Matrix6& information, double limit) {
  if (count_ == 6) return false;
  const Matrix6 all = scaled(information);
  const Eigen::SelfAdjointEigenSolver<Square> solver(free().transpose() * all * free());
  const double most = solver.eigenvalues().maxCoeff();
  Eigen::Index weak = 0;
  while (weak < 6 - count_ && !(solver.eigenvalues()[weak] > limit * most)) ++weak;
  const Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> turned = free() * solver.eigenvectors();
  basis_.rightCols(6 - count_) = turned;
  count_ += weak;
  return weak > 0;
}

Vector6 HeldDirections::step(const Matrix6& matrix, const Vector6& gradient) const {
  if (count_ == 0) return -matrix.ldlt().solve(gradient);
  if (count_ == 6) return Vector6::Zero();
  const Vector6 units = unitsOf(range_);
  const Square part = free().transpose() * scaled(matrix) * free();
  return -units.cwiseProduct(free() * part.ldlt().solve(free().transpose() * units.cwiseProduct(gradient)));
}

PoseCovariance HeldDirections::covarianceOf(const Matrix6& information) const {
  Matrix6 covariance = range_ * range_ * held() * held().transpose();
  if (count_ < 6) {
    const Eigen::SelfAdjointEigenSolver<Square> solver(free().transpose() * scaled(information) * free());
    // Without a lower limit, rounding could make an eigenvalue zero or negative.
    const Eigen::VectorXd told = solver.eigenvalues().cwiseMax(1e-12 * solver.eigenvalues().maxCoeff());
    const Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6> axes = free() * solver.eigenvectors();
    covariance += axes * told.cwiseInverse().asDiagonal() * axes.transpose();
  }
  covariance = scaled(covariance);
  return 0.5 * (covariance + covariance.transpose());
}

PoseDirection leastObservable(const Matrix6& information, double range) {
  const Vector6 units = unitsOf(range);
  const Matrix6 scaled = units.asDiagonal() * information * units.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Matrix6>(scaled).eigenvectors().col(0);
}

}  // namespace gaussmap::detail
