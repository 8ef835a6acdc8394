// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "gaussmap/core/pose.h"
#include "registration/normal_equations.h"

namespace gaussmap::detail {

/// The directions along which a search does not move the pose: they are held. N = 6 in space, 3 in the plane (x, y,
/// heading).
///
/// To compare rotations with translations, the directions are in scaled units: x, y, z [m], then the rotation vector
/// times the RMS range of the scan [m].
template <int N>
class HeldPoseDirections {
 public:
  using PoseVector = Eigen::Matrix<double, N, 1>;
  using PoseMatrix = Eigen::Matrix<double, N, N>;

  /// Holds no direction. `range`: RMS range of the scan [m], > 0.
  explicit HeldPoseDirections(double range) : range_(range) {}

  /// Also holds all free directions with little information: at most `limit` times that of the best free direction.
  /// Returns true if at least one direction was added.
  bool hold(const PoseMatrix& information, double limit);

  bool isEmpty() const { return count_ == 0; }
  /// Returns the step -A^-1 g within the directions that are free. Without held directions, this is the exact solution.
  PoseVector step(const PoseMatrix& matrix, const PoseVector& gradient) const;
  /// Returns the covariance of the pose: the inverse of the information along the free directions, and a standard
  /// deviation of `range` (scaled units: 1 rad for rotations) along the held ones. It is symmetric positive definite.
  PoseMatrix covarianceOf(const PoseMatrix& information) const;

 private:
  PoseMatrix scaled(const PoseMatrix& matrix) const;
  auto held() const { return basis_.leftCols(count_); }
  auto free() const { return basis_.rightCols(N - count_); }

  double range_;
  PoseMatrix basis_ = PoseMatrix::Identity();  // orthonormal, scaled units; the held directions first
  Eigen::Index count_ = 0;                     // of held directions
};

using HeldDirections = HeldPoseDirections<6>;
using HeldPlanarDirections = HeldPoseDirections<3>;

/// Returns the direction with the least information, as a unit vector in scaled units, see HeldPoseDirections.
PoseDirection leastObservable(const NormalEquations::Matrix6& information, double range);
/// Returns the same in the plane: (x, y, heading).
Eigen::Vector3d leastObservable(const Eigen::Matrix3d& information, double range);

}  // namespace gaussmap::detail
