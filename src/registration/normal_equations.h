// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "gaussmap/core/pose.h"

namespace gaussmap::detail {

/// The cost at a pose and its derivatives by (x, y, z [m], rotation vector about the sensor [rad]), map axes:
/// cost = sum_i rho(d_i^2), rho(d^2) = d^2 / (1 + d^2 / k^2).
struct NormalEquations {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  Matrix6 information = Matrix6::Zero();  ///< J' W J
  Vector6 gradient = Vector6::Zero();     ///< half the derivative of the cost
  double cost = 0.0;                      ///< a Gaussian of the scan without a partner in the map adds k^2
  std::size_t met = 0;                    ///< Gaussians of the scan with a partner in the map
  std::size_t near = 0;                   ///< of these, within 3 standard deviations
  double near_squared = 0.0;              ///< sum of the squared Mahalanobis distances of these

  NormalEquations& operator+=(const NormalEquations& other);
};

/// Returns the pose moved by a vector of these six parameters.
Pose moved(const Pose& pose, const NormalEquations::Vector6& by);

}  // namespace gaussmap::detail
