// SPDX-License-Identifier: BSD-3-Clause
#include "registration/planar_search.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "registration/planar_neighbours.h"
#include "registration/scan_gaussians.h"
#include "registration/steps.h"

namespace gaussmap::detail {
namespace {

/// Damped Gauss-Newton iterations on one scale, as in descend().
void descendInPlane(PlanarNeighbours& near, double blur, double kernel, const DescentLimits& limits,
                    const PlanarHold& held, PlanarFit& here) {
  here.equations = near.linearise(here.pose, blur, kernel);
  here.converged = false;
  double damping = 1e-6;
  for (int i = 0; i < limits.max_iterations && here.equations.met > 0 && !here.converged; ++i) {
    ++here.iterations;
    Eigen::Matrix3d damped = here.equations.information;
    const double least = 1e-9 * damped.diagonal().maxCoeff();  // directions without information do not move
    for (int axis = 0; axis < 3; ++axis) damped(axis, axis) += damping * damped(axis, axis) + least;
    const Eigen::Vector3d by = held.step(damped, here.equations.gradient);
    const PlanarPose next{here.pose.position + by.head<2>(), here.pose.heading + by.z()};
    const PlanarEquations there = near.linearise(next, blur, kernel);
    here.converged = by.head<2>().norm() < limits.translation && std::abs(by.z()) < limits.rotation;
    if (there.cost <= here.equations.cost) {
      here.pose = next;
      here.equations = there;
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping = std::max(1e-3, 10.0 * damping);
      if (damping > 1e6) here.converged = true;  // no step lowers the cost
    }
  }
}

}  // namespace

PlanarScan::PlanarScan(const GaussianMap<2>& source, double fine_side, std::size_t most)
    : fine(gaussiansOf<2>(source, fine_side, most)),
      coarse(gaussiansOf<2>(source, kCoarse * fine_side, most)),
      side(fine_side) {
  double squared = 0.0;
  for (const Gaussian<2>& gaussian : fine) squared += gaussian.mean.squaredNorm() / double(fine.size());
  range = std::max(1e-6, std::sqrt(squared));
}

PlanarFit searchInPlane(const PlanarScan& scan, const GaussianMap<2>& map, const PlanarPose& start,
                        const Vector<2>& origin, const PlanarHold& held, const RegistrationOptions& options) {
  PlanarFit found;
  found.pose = start;
  std::optional<PlanarNeighbours> near;
  int scale = -1;
  const std::vector<Gaussian<2>>* used = nullptr;
  const std::vector<Step> steps = stepsOf(map);
  for (const Step& step : steps) {
    const bool final = &step == &steps.back();
    const auto* const now = !final && map.grid().side(step.scale) > scan.side ? &scan.coarse : &scan.fine;
    if (step.scale != scale || now != used) near.emplace(map, scale = step.scale, *(used = now), origin);
    descendInPlane(*near, step.blur, options.kernel, limitsOf(step, final, options), held, found);
  }
  // Which directions the walls tell is judged at the scale whose Gaussians look most like pieces of walls. In small
  // cells, a Gaussian can be a single point; in large ones, it can hold both walls of a corridor.
  double best = 0.0;
  for (const Step& step : steps) {
    if (&step != &steps.back() && (&step)[1].scale == step.scale) continue;  // only the second step of a scale
    PlanarNeighbours at_scale(map, step.scale, scan.fine, origin);
    const PlanarNeighbours::Surfaces surfaces = at_scale.surfacesAt(found.pose, step.blur, options.kernel);
    if (surfaces.share < best) continue;
    best = surfaces.share;
    found.surfaces = surfaces.information;
  }
  return found;
}

}  // namespace gaussmap::detail
