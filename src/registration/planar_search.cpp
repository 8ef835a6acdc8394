// SPDX-License-Identifier: BSD-3-Clause
#include "registration/planar_search.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "registration/planar_neighbours.h"
#include "registration/scan_gaussians.h"
#include "registration/steps.h"
#include "registration/wall_normals.h"

namespace gaussmap::detail {
namespace {

/// Damped Gauss-Newton iterations on one scale, as in descend().
void descendInPlane(PlanarNeighbours& near, double blur, double kernel, const DescentLimits& limits,
                    const HeldPlanarDirections& held, PlanarFit& here) {
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
    here.converged = by.head<2>().norm() <= limits.translation && std::abs(by.z()) <= limits.rotation;
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

/// A step from coarse to fine.
struct PlanarStep {
  int scale;
  double blur;     // [m]
  bool is_coarse;  // the step uses the coarse Gaussians of the scan
};

/// Returns two steps per scale of the map, from the coarsest to the finest.
std::vector<PlanarStep> planarSteps(const GaussianMap<2>& map, double side) {
  std::vector<PlanarStep> steps;
  for (int scale = map.scales() - 1; scale >= 0; --scale) {
    if (map.cellCount(scale) == 0) continue;  // possible in a compressed map
    for (const double part : {kFirstBlur, kLastBlur})
      steps.push_back({scale, part * map.grid().side(scale), map.grid().side(scale) > side});
  }
  if (!steps.empty()) steps.back().is_coarse = false;
  return steps;
}

Eigen::Matrix3d wallNormalsAt(const PlanarPose& pose, const PlanarScan& scan, const GaussianMap<2>& map,
                              const Vector<2>& origin, double kernel) {
  std::vector<PlanarScale> scales;
  for (int scale = 0; scale < map.scales(); ++scale)
    if (map.cellCount(scale) > 0)
      scales.push_back({PlanarNeighbours(map, scale, scan.fine, origin), kLastBlur * map.grid().side(scale)});
  return sumOfWallNormals(scan.fine, scales, pose, kernel);
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
                        const Vector<2>& origin, const HeldPlanarDirections& held, const RegistrationOptions& options) {
  const std::vector<PlanarStep> steps = planarSteps(map, scan.side);
  std::vector<std::shared_ptr<PlanarNeighbours>> near;  // per step; the steps of a scale share them
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const bool is_shared =
        i > 0 && steps[i].scale == steps[i - 1].scale && steps[i].is_coarse == steps[i - 1].is_coarse;
    near.push_back(is_shared ? near.back()
                             : std::make_shared<PlanarNeighbours>(
                                   map, steps[i].scale, steps[i].is_coarse ? scan.coarse : scan.fine, origin));
  }
  // Cells that are as large as rooms find a pose that is far away, but they move a good guess away from its place. So
  // one search begins at every scale, and that with the least cost at the end is the result.
  PlanarFit best;
  int iterations = 0;
  for (std::size_t first = 0; first < steps.size(); ++first) {
    if (first > 0 && steps[first].scale == steps[first - 1].scale) continue;
    PlanarFit found;
    found.pose = start;
    for (std::size_t i = first; i < steps.size(); ++i)
      descendInPlane(*near[i], steps[i].blur, options.kernel, limitsOf(steps[i].blur, i + 1 == steps.size(), options),
                     held, found);
    iterations += found.iterations;
    if (first == 0 || found.equations.cost < best.equations.cost) best = found;
  }
  best.iterations = iterations;
  best.surfaces = wallNormalsAt(best.pose, scan, map, origin, options.kernel);
  return best;
}

}  // namespace gaussmap::detail
