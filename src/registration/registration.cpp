// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/registration/registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>

#include "gaussmap/mapping/build.h"
#include "registration/check_options.h"
#include "registration/descend.h"
#include "registration/map_neighbours.h"
#include "registration/normal_equations.h"
#include "registration/observability.h"
#include "registration/scan_gaussians.h"
#include "registration/scan_on_map.h"
#include "registration/steps.h"
#include "registration/surface_normals.h"

namespace gaussmap {
using namespace detail;

namespace {

/// A step from coarse to fine.
struct Step {
  MapNeighbours* near;  // of the scale
  double side;          // of its cells [m]
  double blur;          // [m]
};

/// The neighbours of all scales that have cells, and the steps of a search over them.
class Scales {
 public:
  /// All coordinates are relative to `origin`, to keep their precision far from zero.
  Scales(const GaussianMap<3>& map, const Vector<3>& origin) {
    for (int scale = 0; scale < map.scales(); ++scale) {
      if (map.cellCount(scale) == 0) continue;  // possible in a compressed map
      all_.push_back(std::make_unique<MapNeighbours>(map, scale, origin));
      near_.push_back(all_.back().get());
      const double side = map.grid().side(scale);
      steps_.insert(steps_.begin(), {{near_.back(), side, kFirstBlur * side}, {near_.back(), side, kLastBlur * side}});
    }
  }
  const std::vector<Step>& steps() const { return steps_; }
  /// Finest first. After a search, their blur is that of the last step of their scale.
  const std::vector<MapNeighbours*>& neighbours() const { return near_; }

 private:
  std::vector<std::unique_ptr<MapNeighbours>> all_;
  std::vector<MapNeighbours*> near_;
  std::vector<Step> steps_;
};

/// What a search from the coarsest scale to the finest finds.
struct Found {
  Pose pose;                          // relative to the origin of the search
  NormalEquations equations;          // at `pose`
  NormalEquations::Matrix6 surfaces;  // sum of normals at `pose`
  int iterations = 0;
  bool converged = false;
};

/// The Gaussians that represent a scan.
struct Source {
  std::vector<Gaussian<3>> fine, coarse;
  double side;   // of the cells of `fine` [m]
  double range;  // root mean square [m]
  bool planar;   // of a planar laser

  Source(const GaussianMap<3>& source, double fine_side, std::size_t most)
      : fine(gaussiansOf<3>(source, fine_side, most)),
        coarse(gaussiansOf<3>(source, kCoarse * fine_side, most)),
        side(fine_side),
        range(rmsRangeOf(fine)),
        planar(isOfPlanarLaser(fine)) {}
};

/// Searches the pose from a start, without moving it along the directions `held`.
Found search(const Source& source, const Scales& scales, const Pose& start, const HeldDirections& held,
             const RegistrationOptions& options) {
  Found found{start, {}, {}};
  for (const Step& step : scales.steps()) {
    step.near->setBlur(step.blur);
    const bool final = &step == &scales.steps().back();
    const auto& scan = !final && step.side > source.side ? source.coarse : source.fine;
    ScanOnMap on_map(scan, *step.near, options.kernel, options.threads);
    const DescentResult down = descend([&](const Pose& where) { return on_map.linearise(where); }, found.pose,
                                       limitsOf(step.blur, final, options), held);
    found.pose = down.pose;
    found.equations = down.equations;
    found.iterations += down.iterations;
    found.converged = down.converged;
  }
  found.surfaces = sumOfNormals(source.fine, scales.neighbours(), found.pose, options.kernel, source.planar);
  return found;
}

RegistrationResult align(const GaussianMap<3>& source_map, const GaussianMap<3>& map, double side, const Pose& guess,
                         const RegistrationOptions& options) {
  RegistrationResult result;
  result.pose = normalised(guess);
  const Source source(source_map, side, options.max_gaussians);
  if (source.fine.empty()) return result;
  const Vector<3> origin = guess.translation;
  const Scales scales(map, origin);
  Pose start = result.pose;
  start.translation.setZero();
  // Which directions are unobservable is clear only at the end of a search. By then, the coarse scales may have moved
  // the pose along them, towards the borders of the seen area. So the search starts again, and holds them.
  HeldDirections held(source.range);
  Found found;
  do {
    found = search(source, scales, start, held, options);
    result.iterations += found.iterations;
    if (found.equations.met < kFewestPairs || !(found.surfaces.trace() > 0.0)) return result;
  } while (held.hold(found.surfaces, options.degenerate));
  result.least_observable = leastObservable(found.surfaces, source.range);
  result.pose = found.pose;
  result.pose.translation += origin;
  result.covariance = held.covarianceOf(found.equations.information);
  result.fitness = double(found.equations.near) / double(source.fine.size());
  if (found.equations.near > 0) result.mean_squared = found.equations.near_squared / double(found.equations.near);
  result.converged = found.converged;
  result.degenerate = !held.isEmpty();
  return result;
}

double sideOf(const GaussianMap<3>& map, const RegistrationOptions& options) {
  return options.resolution > 0.0 ? options.resolution : map.grid().side(0);
}

}  // namespace

RegistrationResult registerScan(const std::vector<Eigen::Vector3d>& points, const GaussianMap<3>& map,
                                const Pose& guess, const RegistrationOptions& options) {
  checkRegistration(map.empty(), guess, options);
  const double side = sideOf(map, options);
  return align(build<3>(points, {side, kCoarse, 2, 0.0}), map, side, guess, options);
}

RegistrationResult registerMap(const GaussianMap<3>& source, const GaussianMap<3>& map, const Pose& guess,
                               const RegistrationOptions& options) {
  checkRegistration(map.empty(), guess, options);
  return align(source, map, sideOf(map, options), guess, options);
}

}  // namespace gaussmap
