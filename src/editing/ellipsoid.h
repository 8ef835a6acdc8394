// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// The ellipsoid around the mean of a Gaussian that holds 95 % of its mass: a solid.
class Ellipsoid95 {
 public:
  /// Throws std::domain_error if the covariance is not finite.
  explicit Ellipsoid95(const Gaussian<3>& gaussian);

  /// Distance [m] from a point to the nearest point of the ellipsoid, 0 inside.
  double distance(const Vector<3>& point) const;

 private:
  Vector<3> centre_;
  Matrix<3> axes_;       // unit vectors, one a column
  Vector<3> half_axes_;  // [m]
};

}  // namespace gaussmap::detail
