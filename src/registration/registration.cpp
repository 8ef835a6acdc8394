// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/registration/registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "gaussmap/mapping/build.h"
#include "registration/descend.h"
#include "registration/map_neighbours.h"
#include "registration/normal_equations.h"
#include "registration/scan_gaussians.h"
#include "registration/scan_on_map.h"

namespace gaussmap {
using namespace detail;

namespace {

using Vector6 = NormalEquations::Vector6;
using Matrix6 = NormalEquations::Matrix6;

void check(const GaussianMap<3>& map, const Pose& guess, const RegistrationOptions& options) {
  if (map.empty()) throw std::invalid_argument("the map is empty: there is nothing to register with");
  if (const std::string fault = poseFault(guess); !fault.empty()) throw std::invalid_argument("guess: " + fault);
  require(options.resolution >= 0.0 && std::isfinite(options.resolution), "resolution", options.resolution,
          "must be positive and finite (0 = the finest cells)");
  require(options.max_gaussians >= 1, "max_gaussians", double(options.max_gaussians), "must be at least 1");
  require(options.max_iterations >= 1, "max_iterations", options.max_iterations, "must be at least 1");
  require(options.kernel > 0.0, "kernel", options.kernel, "must be positive");
  require(options.translation > 0.0, "translation", options.translation, "must be positive");
  require(options.rotation > 0.0, "rotation", options.rotation, "must be positive");
  require(options.degenerate >= 0.0, "degenerate", options.degenerate, "must not be negative");
  require(options.threads >= 0, "threads", options.threads, "must be at least 1 (0 = all)");
}

constexpr int kCoarse = 4;  // factor by which the scan's cells are wider at the coarse scales of the map

/// A step from coarse to fine.
struct Step {
  int scale;
  double blur;  // [m]
};

std::vector<Step> stepsOf(const GaussianMap<3>& map) {
  std::vector<Step> steps;
  for (int scale = map.scales() - 1; scale >= 0; --scale) {
    if (map.cellCount(scale) == 0) continue;  // possible in a compressed map
    const double side = map.grid().side(scale);
    for (const double part : {0.3, 0.1}) steps.push_back({scale, part * side});
  }
  return steps;
}

/// Returns the limits of a step. Before the last step, a hundredth of the blur is accurate enough.
DescentLimits limitsOf(const Step& step, bool last, const RegistrationOptions& options) {
  const double translation = std::max(options.translation, last ? 0.0 : 0.01 * step.blur);
  return {options.max_iterations, translation, translation / options.translation * options.rotation};
}

/// Computes the covariance of the pose, and finds the direction with the least information. Multiplies rotations by the
/// range, to make them comparable with metres.
void judge(const NormalEquations& sums, double range, const RegistrationOptions& options, RegistrationResult& result) {
  if (sums.met == 0) return;
  Vector6 unit = Vector6::Ones();
  unit.tail<3>().setConstant(1.0 / range);
  const Matrix6 scaled = unit.asDiagonal() * sums.information * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scaled);
  const Vector6& told = solver.eigenvalues();
  if (!(told[5] > 0.0)) return;  // all partners in the map fill their cells
  result.degenerate = !(told[0] > options.degenerate * told[5]);
  result.least_observable = solver.eigenvectors().col(0);
  const Vector6 variances = told.cwiseMax(1e-12 * told[5]).cwiseInverse();
  const Matrix6 covariance = solver.eigenvectors() * variances.asDiagonal() * solver.eigenvectors().transpose();
  result.covariance = unit.asDiagonal() * covariance * unit.asDiagonal();
  result.covariance = 0.5 * (result.covariance + result.covariance.transpose()).eval();
}

RegistrationResult align(const GaussianMap<3>& source, const GaussianMap<3>& map, double side, const Pose& guess,
                         const RegistrationOptions& options) {
  RegistrationResult result;
  result.pose = normalised(guess);
  const std::vector<Gaussian<3>> fine = gaussiansOf(source, side, options.max_gaussians),
                                 coarse = gaussiansOf(source, kCoarse * side, options.max_gaussians);
  if (fine.empty()) return result;
  const Vector<3> origin = guess.translation;  // all sums are relative to it, to keep their precision far from zero
  Pose pose = result.pose;
  pose.translation.setZero();
  NormalEquations last;
  std::optional<MapNeighbours> near;
  int scale = -1;
  const std::vector<Step> steps = stepsOf(map);
  for (const Step& step : steps) {
    if (step.scale != scale) near.emplace(map, scale = step.scale, origin);
    near->setBlur(step.blur);
    const bool final = &step == &steps.back();
    const auto& scan = !final && map.grid().side(scale) > side ? coarse : fine;
    ScanOnMap on_map(scan, *near, options.kernel, options.threads);
    const DescentResult down =
        descend([&](const Pose& where) { return on_map.linearise(where); }, pose, limitsOf(step, final, options));
    pose = down.pose;
    last = down.equations;
    result.iterations += down.iterations;
    result.converged = down.converged;
  }
  result.pose = pose;
  result.pose.translation += origin;
  result.fitness = double(last.near) / double(fine.size());
  if (last.near > 0) result.mean_squared = last.near_squared / double(last.near);
  double squared_range = 0.0;
  for (const Gaussian<3>& gaussian : fine) squared_range += gaussian.mean.squaredNorm() / double(fine.size());
  judge(last, std::max(1e-6, std::sqrt(squared_range)), options, result);
  return result;
}

double sideOf(const GaussianMap<3>& map, const RegistrationOptions& options) {
  return options.resolution > 0.0 ? options.resolution : map.grid().side(0);
}

}  // namespace

RegistrationResult registerScan(const std::vector<Eigen::Vector3d>& points, const GaussianMap<3>& map,
                                const Pose& guess, const RegistrationOptions& options) {
  check(map, guess, options);
  const double side = sideOf(map, options);
  return align(build<3>(points, {side, kCoarse, 2, 0.0}), map, side, guess, options);
}

RegistrationResult registerMap(const GaussianMap<3>& source, const GaussianMap<3>& map, const Pose& guess,
                               const RegistrationOptions& options) {
  check(map, guess, options);
  return align(source, map, sideOf(map, options), guess, options);
}

}  // namespace gaussmap
