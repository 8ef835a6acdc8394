// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "registration/normal_equations.h"
#include "registration/observability.h"

namespace gaussmap::detail {

struct DescentLimits {
  int max_iterations;
  double translation;  ///< converged when an iteration moves at most this [m] ...
  double rotation;     ///< ... and turns at most this [rad]
};

/// The result of descend(). PoseT, Equations: Pose, NormalEquations in space; PlanarPose, PlanarEquations in the plane.
template <typename PoseT, typename Equations>
struct Descent {
  PoseT pose;
  Equations equations;  ///< at `pose`
  int iterations = 0;
  bool converged = false;
};
using DescentResult = Descent<Pose, NormalEquations>;

/// Minimises the cost by damped Gauss-Newton iterations (Levenberg, Marquardt). A step that raises the cost is
/// rejected, and the next one is shorter. at(pose) returns the equations at a pose. The pose does not move along the
/// directions `held`. N = 6 in space, 3 in the plane.
template <int N, typename PoseT, typename EquationsAt>
auto descend(const EquationsAt& at, const PoseT& start, const DescentLimits& limits,
             const HeldPoseDirections<N>& held) {
  constexpr int kTranslation = N == 6 ? 3 : 2;  // number of coordinates; the rotation follows them
  Descent<PoseT, decltype(at(start))> here{start, at(start)};
  double damping = 1e-6;
  while (here.iterations < limits.max_iterations && here.equations.met > 0 && !here.converged) {
    ++here.iterations;
    Eigen::Matrix<double, N, N> damped = here.equations.information;
    const double least = 1e-9 * damped.diagonal().maxCoeff();  // directions without information do not move
    for (int axis = 0; axis < N; ++axis) damped(axis, axis) += damping * damped(axis, axis) + least;
    const Eigen::Matrix<double, N, 1> by = held.step(damped, here.equations.gradient);
    const PoseT next = moved(here.pose, by);
    const auto there = at(next);
    here.converged = by.template head<kTranslation>().norm() <= limits.translation &&
                     by.template tail<N - kTranslation>().norm() <= limits.rotation;
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
