// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "gaussmap/core/gaussian.h"

namespace gaussmap::detail {

/// How a Gaussian's ellipsoid is turned and how long it is: Sigma = R diag(deviations)^2 R'.
struct EllipsoidPose {
  Eigen::Quaternion<double, Eigen::DontAlign> rotation;  ///< R, unit, w >= 0: from the ellipsoid's axes to the map's
  Vector<3> deviations;                                  ///< standard deviations along its axes [m], ascending

  /// The axis of least deviation, of the two signs the one that points up (else along +y, +x): a normal to draw.
  Vector<3> normal() const;
};

/// Variances that rounding made negative count as 0. Throws std::domain_error if the covariance is not finite.
EllipsoidPose ellipsoidPose(const Gaussian<3>& gaussian);

}  // namespace gaussmap::detail
