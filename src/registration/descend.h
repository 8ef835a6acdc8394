// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "gaussmap/core/pose.h"
#include "registration/normal_equations.h"
#include "registration/observability.h"

namespace gaussmap::detail {

struct DescentLimits {
  int max_iterations;
  double translation;  ///< converged when an iteration moves at most this [m] ...
  double rotation;     ///< ... and turns at most this [rad]
};

struct DescentResult {
  Pose pose;
  NormalEquations equations;  ///< at `pose`
  int iterations = 0;
  bool converged = false;
};

/// Minimises the cost by damped Gauss-Newton iterations (Levenberg, Marquardt). A step that raises the cost is
/// rejected, and the next one is shorter. at(pose) returns the equations at a pose. The pose does not move along the
/// directions `held`.
DescentResult descend(const std::function<NormalEquations(const Pose&)>& at, const Pose& start,
                      const DescentLimits& limits, const HeldDirections& held = HeldDirections(1.0));

}  // namespace gaussmap::detail
