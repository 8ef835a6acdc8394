// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// A pose in the plane, relative to the origin of a registration.
struct PlanarPose {
  Vector<2> position = Vector<2>::Zero();  ///< [m]
  double heading = 0.0;                    ///< [rad], counter-clockwise from the x axis of the map

  Matrix<2> rotation() const;
};

/// The cost at a planar pose and its derivatives by (x, y [m], heading about the sensor [rad]):
/// cost = sum_i rho(d_i^2), rho(d^2) = d^2 / (1 + d^2 / k^2), as in NormalEquations.
struct PlanarEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< J' W J
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();     ///< half the derivative of the cost
  double cost = 0.0;          ///< a Gaussian of the scan without a partner in the map adds k^2
  std::size_t met = 0;        ///< Gaussians of the scan with a partner in the map
  std::size_t near = 0;       ///< of these, within 3 standard deviations
  double near_squared = 0.0;  ///< sum of the squared Mahalanobis distances of these
};

/// Directions of a planar pose along which a search keeps its start, because the map says too little about them.
///
/// To compare the heading with x and y, the directions are in scaled units: x, y [m], heading times the RMS range of
/// the scan [m].
class PlanarHold {
 public:
  /// Holds no direction. `range`: RMS range of the scan [m], > 0.
  explicit PlanarHold(double range) : units_(1.0, 1.0, 1.0 / range), range_(range) {}

  /// Holds all directions with little information, too: at most `limit` times that of the best direction.
  /// Returns true if there is at least one that was not held before.
  bool hold(const Eigen::Matrix3d& information, double limit);

  bool isEmpty() const { return count_ == 0; }
  /// Returns the step -A^-1 g within the directions that are free.
  Eigen::Vector3d step(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& gradient) const;
  /// Returns the covariance of (x, y, heading): the inverse of the information along the free directions, and a
  /// standard deviation of `range` (1 rad for the heading) along the held ones. It is symmetric positive definite.
  Eigen::Matrix3d covarianceOf(const Eigen::Matrix3d& information) const;
  /// Returns the direction with the least information, as a unit vector in scaled units.
  Eigen::Vector3d leastObservable(const Eigen::Matrix3d& information) const;

 private:
  Eigen::Matrix3d scaled(const Eigen::Matrix3d& matrix) const {
    return units_.asDiagonal() * matrix * units_.asDiagonal();
  }
  auto held() const { return basis_.leftCols(count_); }
  auto free() const { return basis_.rightCols(3 - count_); }

  Eigen::Vector3d units_;  // change of the pose per scaled unit
  double range_;
  Eigen::Matrix3d basis_ = Eigen::Matrix3d::Identity();  // orthonormal, scaled units; the held directions first
  Eigen::Index count_ = 0;                               // of held directions
};

}  // namespace gaussmap::detail
