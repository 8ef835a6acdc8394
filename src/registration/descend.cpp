// SPDX-License-Identifier: BSD-3-Clause
#include "registration/descend.h"

#include <algorithm>

namespace gaussmap::detail {

DescentResult descend(const std::function<NormalEquations(const Pose&)>& at, const Pose& start,
                      const DescentLimits& limits, const HeldDirections& held) {
  DescentResult here{start, at(start)};
  double damping = 1e-6;
  while (here.iterations < limits.max_iterations && here.equations.met > 0 && !here.converged) {
    ++here.iterations;
    NormalEquations::Matrix6 damped = here.equations.information;
    const double least = 1e-9 * damped.diagonal().maxCoeff();  // directions without information do not move
    for (int axis = 0; axis < 6; ++axis) damped(axis, axis) += damping * damped(axis, axis) + least;
    const NormalEquations::Vector6 by = held.step(damped, here.equations.gradient);
    const Pose next = moved(here.pose, by);
    const NormalEquations there = at(next);
    here.converged = by.head<3>().norm() <= limits.translation && by.tail<3>().norm() <= limits.rotation;
    if (there.cost <= here.equations.cost) {
      here.pose = next;
      here.equations = there;
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping = std::max(1e-3, 10.0 * damping);
      if (damping > 1e6) here.converged = true;  // no step lowers the cost
    }
  }
  return here;
}

}  // namespace gaussmap::detail
