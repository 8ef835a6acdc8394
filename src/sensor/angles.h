// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/pi.h"

namespace gaussmap::detail {

/// Returns the angle about the z axis, counted from x to y, in [-pi, pi] [rad].
inline double azimuthOf(const Eigen::Vector3d& point) {
  return std::atan2(point.y(), point.x());
}

/// Returns the angle above the xy plane, in [-pi / 2, pi / 2] [rad].
inline double elevationOf(const Eigen::Vector3d& point) {
  return std::atan2(point.z(), std::hypot(point.x(), point.y()));
}

}  // namespace gaussmap::detail
