// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/registration/registration.h"
#include "registration/descend.h"

namespace gaussmap::detail {

constexpr int kCoarse = 4;  // factor by which the scan's cells are wider at the coarse scales of the map

/// A step from coarse to fine.
struct Step {
  int scale;
  double blur;  ///< [m]
};

/// Returns two steps per scale of the map, from the coarsest to the finest.
template <int D>
std::vector<Step> stepsOf(const GaussianMap<D>& map) {
  std::vector<Step> steps;
  for (int scale = map.scales() - 1; scale >= 0; --scale) {
    if (map.cellCount(scale) == 0) continue;  // possible in a compressed map
    const double side = map.grid().side(scale);
    for (const double part : {0.3, 0.1}) steps.push_back({scale, part * side});
  }
  return steps;
}

/// Returns the limits of a step. Before the last step, a hundredth of the blur is accurate enough.
inline DescentLimits limitsOf(const Step& step, bool last, const RegistrationOptions& options) {
  const double translation = std::max(options.translation, last ? 0.0 : 0.01 * step.blur);
  return {options.max_iterations, translation, translation / options.translation * options.rotation};
}

}  // namespace gaussmap::detail
