// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// A pose in the plane. Its position is relative to the origin of the registration.
struct PlanarPose {
  Vector<2> position = Vector<2>::Zero();  ///< [m]
  double heading = 0.0;                    ///< [rad], counter-clockwise from the x axis of the map

  /// Returns the rotation matrix of the heading.
  Matrix<2> rotation() const;
};

/// The cost at a planar pose, and its derivatives by x, y [m] and the heading about the sensor [rad]. As in
/// NormalEquations: cost = sum_i rho(d_i^2), rho(d^2) = d^2 / (1 + d^2 / k^2).
struct PlanarEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< J' W J
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();     ///< half the derivative of the cost
  double cost = 0.0;          ///< a Gaussian of the scan without a partner in the map adds k^2
  std::size_t met = 0;        ///< Gaussians of the scan with a partner in the map
  std::size_t near = 0;       ///< of these, within 3 standard deviations
  double near_squared = 0.0;  ///< sum of the squared Mahalanobis distances of these
};

/// Returns the pose moved by a vector of (x, y [m], heading [rad]).
PlanarPose moved(const PlanarPose& pose, const Eigen::Vector3d& by);

}  // namespace gaussmap::detail
