// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// The solid ellipsoid around the mean of a Gaussian that holds 95 % of its mass.
class Ellipsoid95 {
 public:
  /// Throws std::domain_error if the covariance is not finite.
  explicit Ellipsoid95(const Gaussian<3>& gaussian);

  /// Returns the distance from a point to the nearest point of the ellipsoid [m]; 0 inside.
  double distance(const Vector<3>& point) const;

 private:
  Vector<3> centre_;
  Matrix<3> axes_;       // unit vectors, in the columns
  Vector<3> half_axes_;  // [m]
};

}  // namespace gaussmap::detail
