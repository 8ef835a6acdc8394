// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// The orientation and the size of a Gaussian's ellipsoid: Sigma = R diag(deviations)^2 R'.
struct GAUSSMAP_API EllipsoidPose {
  Eigen::Quaternion<double, Eigen::DontAlign> rotation;  ///< R, from the ellipsoid's axes to the map's; unit, w >= 0
  Vector<3> deviations;                                  ///< standard deviations along the axes [m], ascending

  /// Returns the axis with the smallest deviation, for example to draw a normal. Of its two directions, it is the one
  /// that points up (horizontal axes: along +y, else +x).
  Vector<3> normal() const;
};

/// Returns the pose of a Gaussian's ellipsoid. Variances that are negative because of rounding count as 0. Throws
/// std::domain_error if the covariance is not finite.
GAUSSMAP_API EllipsoidPose ellipsoidPose(const Gaussian<3>& gaussian);

}  // namespace gaussmap::detail
