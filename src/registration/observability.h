// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "gaussmap/core/pose.h"
#include "registration/normal_equations.h"

namespace gaussmap::detail {

/// Directions of the pose along which a search keeps its start.
///
/// To compare rotations with translations, the directions are in scaled units: x, y, z [m], then the rotation vector
/// times the RMS range of the scan [m].
class HeldDirections {
 public:
  using Vector6 = NormalEquations::Vector6;
  using Matrix6 = NormalEquations::Matrix6;

  /// Holds no direction. `range`: RMS range of the scan [m], > 0.
  explicit HeldDirections(double range) : range_(range) {}

  /// Holds all directions with little information, too: at most `limit` times that of the best direction.
  /// Returns true if there is at least one that was not held before.
  bool hold(const Matrix6& information, double limit);

  bool isEmpty() const { return count_ == 0; }
  /// Returns the step -A^-1 g within the directions that are free. Without held directions, this is the exact solution.
  Vector6 step(const Matrix6& matrix, const Vector6& gradient) const;
  /// Returns the covariance of the pose: the inverse of the information along the free directions, and a standard
  /// deviation of `range` (scaled units: 1 rad for rotations) along the held ones. It is symmetric positive definite.
  PoseCovariance covarianceOf(const Matrix6& information) const;

 private:
  Matrix6 scaled(const Matrix6& matrix) const;
  auto held() const { return basis_.leftCols(count_); }
  auto free() const { return basis_.rightCols(6 - count_); }

  double range_;
  Matrix6 basis_ = Matrix6::Identity();  // orthonormal, scaled units; the held directions first
  Eigen::Index count_ = 0;               // of held directions
};

/// Returns the direction with the least information, as a unit vector in scaled units, see HeldDirections.
PoseDirection leastObservable(const NormalEquations::Matrix6& information, double range);

}  // namespace gaussmap::detail
