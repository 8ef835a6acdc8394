// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "gaussmap/core/pose.h"

namespace gaussmap::detail {

/// Returns the rotation about the z axis by an angle [rad], counter-clockwise.
inline Pose::Rotation aboutZ(double angle) {
  return {std::cos(0.5 * angle), 0.0, 0.0, std::sin(0.5 * angle)};
}

}  // namespace gaussmap::detail
