// SPDX-License-Identifier: BSD-3-Clause
#include "registration/planar_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace gaussmap::detail {
namespace {

using Square3 = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
using Columns3 = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;

}  // namespace

Matrix<2> PlanarPose::rotation() const {
  Matrix<2> matrix;
  matrix << std::cos(heading), -std::sin(heading), std::sin(heading), std::cos(heading);
  return matrix;
}

bool PlanarHold::hold(const Eigen::Matrix3d& information, double limit) {
  if (count_ == 3) return false;
  const Eigen::SelfAdjointEigenSolver<Square3> solver(free().transpose() * scaled(information) * free());
  const double most = solver.eigenvalues().maxCoeff();
  Eigen::Index weak = 0;
  while (weak < 3 - count_ && !(solver.eigenvalues()[weak] > limit * most)) ++weak;
  const Columns3 turned = free() * solver.eigenvectors();
  basis_.rightCols(3 - count_) = turned;
  count_ += weak;
  return weak > 0;
}

Eigen::Vector3d PlanarHold::step(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& gradient) const {
  if (count_ == 3) return Eigen::Vector3d::Zero();
  const Square3 part = free().transpose() * scaled(matrix) * free();
  return -units_.cwiseProduct(free() * part.ldlt().solve(free().transpose() * units_.cwiseProduct(gradient)));
}

Eigen::Matrix3d PlanarHold::covarianceOf(const Eigen::Matrix3d& information) const {
  Eigen::Matrix3d covariance = range_ * range_ * held() * held().transpose();
  if (count_ < 3) {
    const Eigen::SelfAdjointEigenSolver<Square3> solver(free().transpose() * scaled(information) * free());
    // Without a lower limit, rounding could make an eigenvalue zero or negative.
    const Eigen::VectorXd told = solver.eigenvalues().cwiseMax(1e-12 * solver.eigenvalues().maxCoeff());
    const Columns3 axes = free() * solver.eigenvectors();
    covariance += axes * told.cwiseInverse().asDiagonal() * axes.transpose();
  }
  covariance = scaled(covariance);
  return 0.5 * (covariance + covariance.transpose());
}

Eigen::Vector3d PlanarHold::leastObservable(const Eigen::Matrix3d& information) const {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scaled(information)).eigenvectors().col(0);
}

}  // namespace gaussmap::detail
