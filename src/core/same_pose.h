// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/core/pose.h"

namespace gaussmap::detail {

/// Returns true if all numbers of two poses are equal.
inline bool samePose(const Pose& a, const Pose& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

}  // namespace gaussmap::detail
