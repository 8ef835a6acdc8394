// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// The solid ellipsoid (D = 2: ellipse) around the mean of a Gaussian that holds 95 % of its mass.
template <int D>
class Ellipsoid95 {
 public:
  /// Throws std::domain_error if the covariance is not finite.
  explicit Ellipsoid95(const Gaussian<D>& gaussian);

  /// Returns the distance from a point to the nearest point of the ellipsoid [m]; 0 inside.
  double distance(const Vector<D>& point) const;

 private:
  Vector<D> centre_;
  Matrix<D> axes_;       // unit vectors, in the columns
  Vector<D> half_axes_;  // [m]
};

}  // namespace gaussmap::detail
