// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <cmath>
#include <vector>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {

/// Pose of a planar sensor: p_map = R(heading) p_sensor + translation.
struct Pose2 {
  Vector<2> translation{0.0, 0.0};  ///< [m], map frame
  double heading = 0.0;             ///< [rad], counter-clockwise
  /// Of (x, y, heading) in the map frame [m, m, rad]; zero: the pose is exact.
  Matrix<3> covariance = Matrix<3>::Zero();

  Vector<2> operator*(const Vector<2>& point) const {
    const double c = std::cos(heading), s = std::sin(heading);
    return Vector<2>(c * point.x() - s * point.y(), s * point.x() + c * point.y()) + translation;
  }
};

/// One sweep of a planar laser in the order of its bearings, so that neighbours in the vectors are neighbouring beams.
struct LaserScan {
  Pose2 pose;
  std::vector<double> bearings;  ///< n [rad], sensor frame, ascending
  std::vector<double> ranges;    ///< n [m]; not finite, <= 0 or >= max_range: no return
  double max_range = 80.0;       ///< [m]

  bool returned(std::size_t beam) const {
    return std::isfinite(ranges[beam]) && ranges[beam] > 0.0 && ranges[beam] < max_range;
  }
  /// End of a beam that returned [m], map frame.
  Vector<2> hit(std::size_t beam) const {
    return pose * Vector<2>(ranges[beam] * std::cos(bearings[beam]), ranges[beam] * std::sin(bearings[beam]));
  }
};

}  // namespace gaussmap
