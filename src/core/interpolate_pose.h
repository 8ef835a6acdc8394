// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "gaussmap/core/pose.h"

namespace gaussmap::detail {

/// Returns the pose between two poses: linear interpolation of the translation, slerp of the rotation. `share`: 0 = a,
/// 1 = b.
inline Pose interpolate(const Pose& a, const Pose& b, double share) {
  const Eigen::Quaterniond qa(a.rotation), qb(b.rotation);
  return normalised({a.translation + share * (b.translation - a.translation), Pose::Rotation(qa.slerp(share, qb))});
}

}  // namespace gaussmap::detail
