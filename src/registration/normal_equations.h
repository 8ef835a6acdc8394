// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "gaussmap/core/pose.h"

namespace gaussmap::detail {

/// Cost at a pose and its derivatives by (x, y, z, rotation vector about the sensor), map axes:
/// cost = sum_i rho(d_i^2), rho(d^2) = d^2 / (1 + d^2 / k^2).
struct NormalEquations {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  Matrix6 information = Matrix6::Zero();  ///< J' W J
  Vector6 gradient = Vector6::Zero();     ///< half the derivative of the cost
  double cost = 0.0;                      ///< Gaussians that meet nothing count k^2
  std::size_t met = 0;                    ///< that meet a Gaussian of the map
  std::size_t near = 0;                   ///< of these, within 3 standard deviations
  double near_squared = 0.0;              ///< sum of their squared distances

  NormalEquations& operator+=(const NormalEquations& other);
};

/// The pose moved by such a six-vector.
Pose moved(const Pose& pose, const NormalEquations::Vector6& by);

}  // namespace gaussmap::detail
