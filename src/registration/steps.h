// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "gaussmap/registration/registration.h"
#include "registration/descend.h"

// Constants and limits of both registrations: in space and in the plane.
namespace gaussmap::detail {

constexpr std::size_t kFewestPairs = 3;  // as pcl::Registration: fewer pairs do not determine a pose
constexpr int kCoarse = 4;               // factor by which the scan's cells are wider at the coarse scales of the map
constexpr double kFirstBlur = 0.3, kLastBlur = 0.1;  // blur of the two steps of a scale, in sides of its cells

/// Returns the limits of a step with this blur [m]. Before the last step, the limits are wider: a hundredth of the blur
/// is accurate enough.
inline DescentLimits limitsOf(double blur, bool last, const RegistrationOptions& options) {
  const double translation = std::max(options.translation, last ? 0.0 : 0.01 * blur);
  const double factor = std::isfinite(translation) ? translation / options.translation : 1.0;
  return {options.max_iterations, translation, factor * options.rotation};
}

}  // namespace gaussmap::detail
