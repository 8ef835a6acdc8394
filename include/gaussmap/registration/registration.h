// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

struct RegistrationOptions {
  /// The scan becomes Gaussians of cells of this side [m], > 0, and of four times that for the coarse scales; 0: as the
  /// map's finest cells.
  double resolution = 0.0;
  std::size_t max_gaussians = 4000;  ///< of the scan that are used at a step, evenly chosen, >= 1
  int max_iterations = 30;           ///< of each step from coarse to fine, >= 1
  double kernel = 3.0;        ///< residuals of this many standard deviations count half as much as they would, > 0
  double translation = 5e-4;  ///< a step is done when an iteration moves less than this [m] ...
  double rotation = 5e-5;     ///< ... and turns less than this [rad]
  double degenerate = 0.01;   ///< least over largest information of a direction below which a pose is degenerate
  int threads = 0;            ///< 0 = all cores; does not change the result
};

struct GAUSSMAP_API RegistrationResult {
  Pose pose;  ///< scan frame to map frame
  /// Of the pose, from the last iteration. Symmetric positive definite; zero if the map tells nothing about the pose.
  PoseCovariance covariance = PoseCovariance::Zero();
  /// The direction that the scan tells least about, of unit length, rotation times range.
  Eigen::Matrix<double, 6, 1> weakest = Eigen::Matrix<double, 6, 1>::Zero();
  double fitness = 0.0;       ///< share of the scan's Gaussians within 3 standard deviations of one of the map
  double mean_squared = 0.0;  ///< of these, the mean squared Mahalanobis distance
  int iterations = 0;
  bool converged = false;  ///< the last step ended before max_iterations
  bool degenerate = true;  ///< the scan does not tell some direction (a corridor, a plain): see `weakest`
};

/// Where a scan was taken: moves it onto a map, from the coarsest scale to the finest. At every scale each Gaussian of
/// the scan looks for the nearest one of the map; the covariances are widened at first by a part of the cells. Damped
/// Gauss-Newton over the squared Mahalanobis distances under a robust kernel (Geman, McClure). A Gaussian of the map
/// says nothing about the directions in which it fills its cell, and one of the finest scale little about others than
/// its thinnest.
///
/// `points` [m, scan frame]; NaN and infinite ones are left out. Throws std::invalid_argument, naming the option, or
/// for an empty map or a guess with a fault.
GAUSSMAP_API RegistrationResult registerScan(const std::vector<Eigen::Vector3d>& points, const GaussianMap<3>& map,
                                             const Pose& guess = {}, const RegistrationOptions& options = {});

/// The same with the Gaussians of another map in place of a scan: distribution to distribution. The pose moves `source`
/// onto `map`.
GAUSSMAP_API RegistrationResult registerMap(const GaussianMap<3>& source, const GaussianMap<3>& map,
                                            const Pose& guess = {}, const RegistrationOptions& options = {});

}  // namespace gaussmap
