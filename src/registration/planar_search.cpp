// SPDX-License-Identifier: BSD-3-Clause
#include "registration/planar_search.h"

#include <memory>
#include <vector>

#include "registration/descend.h"
#include "registration/planar_neighbours.h"
#include "registration/scan_gaussians.h"
#include "registration/steps.h"
#include "registration/wall_normals.h"

namespace gaussmap::detail {
namespace {

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
      side(fine_side),
      range(rmsRangeOf(fine)) {}

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
    for (std::size_t i = first; i < steps.size(); ++i) {
      const auto at = [&](const PlanarPose& pose) { return near[i]->linearise(pose, steps[i].blur, options.kernel); };
      const auto down = descend(at, found.pose, limitsOf(steps[i].blur, i + 1 == steps.size(), options), held);
      found.pose = down.pose;
      found.equations = down.equations;
      found.iterations += down.iterations;
      found.converged = down.converged;
    }
    iterations += found.iterations;
    if (first == 0 || found.equations.cost < best.equations.cost) best = found;
  }
  best.iterations = iterations;
  best.surfaces = wallNormalsAt(best.pose, scan, map, origin, options.kernel);
  return best;
}

}  // namespace gaussmap::detail
