// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/registration/registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "mapping/check_options.h"
#include "registration/map_neighbours.h"
#include "registration/normal_equations.h"
#include "registration/scan_gaussians.h"

namespace gaussmap {
namespace {

using Vector6 = NormalEquations::Vector6;
using Matrix6 = NormalEquations::Matrix6;

void check(const GaussianMap<3>& map, const Pose& guess, const RegistrationOptions& options) {
  if (map.empty()) throw std::invalid_argument("the map is empty: there is nothing to register with");
  if (const std::string fault = poseFault(guess); !fault.empty()) throw std::invalid_argument("guess: " + fault);
  require(options.resolution >= 0.0 && std::isfinite(options.resolution), "resolution", options.resolution,
          "must be positive (0 = twice the finest cells)");
  require(options.most_gaussians >= 1, "most_gaussians", double(options.most_gaussians), "must be at least 1");
  require(options.max_iterations >= 1, "max_iterations", options.max_iterations, "must be at least 1");
  require(options.kernel > 0.0, "kernel", options.kernel, "must be positive");
  require(options.translation > 0.0, "translation", options.translation, "must be positive");
  require(options.rotation > 0.0, "rotation", options.rotation, "must be positive");
  require(options.degenerate >= 0.0, "degenerate", options.degenerate, "must not be negative");
  require(options.threads >= 0, "threads", options.threads, "must not be negative (0 = all)");
}

/// A step from coarse to fine.
struct Step {
  int scale;
  double blur;  // [m]
};

std::vector<Step> stepsOf(const GaussianMap<3>& map) {
  std::vector<Step> steps;
  for (int scale = map.scales() - 1; scale >= 0; --scale) {
    if (map.cellCount(scale) == 0) continue;  // of a compressed map
    const double side = map.grid().side(scale);
    for (const double part : {0.3, 0.1}) steps.push_back({scale, part * side});
  }
  return steps;
}

/// Damped Gauss-Newton at one step (Levenberg, Marquardt). Moves the pose, returns the equations there.
NormalEquations descend(const std::vector<Gaussian<3>>& scan, MapNeighbours& near, double blur, bool last,
                        const RegistrationOptions& options, Pose& pose, RegistrationResult& result) {
  const auto at = [&](const Pose& where) {
    return linearise(scan, where, near, blur, options.kernel, options.threads);
  };
  NormalEquations here = at(pose);
  double damping = 1e-6;
  // Before the last step, a hundredth of the blur is near enough.
  const double translation = std::max(options.translation, last ? 0.0 : 0.01 * blur);
  const double rotation = translation / options.translation * options.rotation;
  result.converged = false;
  for (int i = 0; i < options.max_iterations && here.met > 0 && !result.converged; ++i) {
    ++result.iterations;
    Matrix6 damped = here.information;
    const double least = 1e-9 * damped.diagonal().maxCoeff();  // directions that nothing tells stay
    for (int axis = 0; axis < 6; ++axis) damped(axis, axis) += damping * damped(axis, axis) + least;
    const Vector6 by = -damped.ldlt().solve(here.gradient);
    const Pose next = moved(pose, by);
    const NormalEquations there = at(next);
    result.converged = by.head<3>().norm() < translation && by.tail<3>().norm() < rotation;
    if (there.cost <= here.cost) {
      pose = next;
      here = there;
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping = std::max(1e-3, 10.0 * damping);
      if (damping > 1e6) result.converged = true;  // no way down from here
    }
  }
  return here;
}

/// Which direction the information tells least about; rotations times the range, so that they compare with metres.
void judge(const NormalEquations& sums, double range, const RegistrationOptions& options, RegistrationResult& result) {
  if (sums.met == 0) return;
  Vector6 unit = Vector6::Ones();
  unit.tail<3>().setConstant(1.0 / range);
  const Matrix6 scaled = unit.asDiagonal() * sums.information * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(scaled);
  const Vector6 told = solver.eigenvalues();
  if (!(told[5] > 0.0)) return;  // what it met fills its cells
  result.degenerate = !(told[0] > options.degenerate * told[5]);
  result.weakest = solver.eigenvectors().col(0);
  const Vector6 variances = told.cwiseMax(1e-12 * told[5]).cwiseInverse();
  const Matrix6 covariance = solver.eigenvectors() * variances.asDiagonal() * solver.eigenvectors().transpose();
  result.covariance = unit.asDiagonal() * covariance * unit.asDiagonal();
  result.covariance = 0.5 * (result.covariance + result.covariance.transpose()).eval();
}

RegistrationResult align(const std::vector<Gaussian<3>>& scan, const GaussianMap<3>& map, const Pose& guess,
                         const RegistrationOptions& options) {
  RegistrationResult result;
  result.pose = normalised(guess);
  if (scan.empty()) return result;
  const Vector<3> origin = guess.translation;  // sums are taken about it: nothing is lost far away
  Pose pose = result.pose;
  pose.translation.setZero();
  NormalEquations last;
  std::optional<MapNeighbours> near;
  int scale = -1;
  const std::vector<Step> steps = stepsOf(map);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].scale != scale) near.emplace(map, scale = steps[i].scale, origin);
    last = descend(scan, *near, steps[i].blur, i + 1 == steps.size(), options, pose, result);
  }
  result.pose = pose;
  result.pose.translation += origin;
  result.fitness = double(last.near) / double(scan.size());
  if (last.near > 0) result.mean_squared = last.near_squared / double(last.near);
  double squared_range = 0.0;
  for (const Gaussian<3>& gaussian : scan) squared_range += gaussian.mean.squaredNorm() / double(scan.size());
  judge(last, std::max(1e-6, std::sqrt(squared_range)), options, result);
  return result;
}

double resolutionOf(const GaussianMap<3>& map, const RegistrationOptions& options) {
  return options.resolution > 0.0 ? options.resolution : 2.0 * map.grid().side(0);
}

}  // namespace

RegistrationResult registerScan(const std::vector<Eigen::Vector3d>& points, const GaussianMap<3>& map,
                                const Pose& guess, const RegistrationOptions& options) {
  check(map, guess, options);
  return align(gaussiansOf(points, resolutionOf(map, options), options), map, guess, options);
}

RegistrationResult registerMap(const GaussianMap<3>& source, const GaussianMap<3>& map, const Pose& guess,
                               const RegistrationOptions& options) {
  check(map, guess, options);
  return align(gaussiansOf(source, resolutionOf(map, options), options), map, guess, options);
}

}  // namespace gaussmap
