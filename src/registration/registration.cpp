// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/registration/registration.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "gaussmap/mapping/build.h"
#include "registration/check_options.h"
#include "registration/descend.h"
#include "registration/map_neighbours.h"
#include "registration/normal_equations.h"
#include "registration/scan_gaussians.h"
#include "registration/scan_on_map.h"
#include "registration/steps.h"

namespace gaussmap {
using namespace detail;

namespace {

using Vector6 = NormalEquations::Vector6;
using Matrix6 = NormalEquations::Matrix6;

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
  const std::vector<Gaussian<3>> fine = gaussiansOf<3>(source, side, options.max_gaussians),
                                 coarse = gaussiansOf<3>(source, kCoarse * side, options.max_gaussians);
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
