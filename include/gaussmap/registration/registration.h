// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of registerScan() and registerMap().
struct RegistrationOptions {
  /// Side of the cells [m] whose Gaussians represent the scan at the fine scales of the map, > 0. At the coarse scales
  /// the cells are four times as wide. 0: the side of the map's finest cells.
  double resolution = 0.0;
  std::size_t max_gaussians = 4000;  ///< maximum number of scan Gaussians per step, evenly chosen, >= 1
  int max_iterations = 30;           ///< maximum per step from coarse to fine, >= 1
  double kernel = 3.0;               ///< a residual of this many standard deviations has half of its usual cost, > 0
  double translation = 5e-4;  ///< a step ends when an iteration moves less than this [m] and less than `rotation`
  double rotation = 5e-5;     ///< a step ends when an iteration turns less than this [rad] and less than `translation`
  double degenerate = 0.01;   ///< a pose is degenerate if smallest / largest information is at most this ratio
  int threads = 0;            ///< 0 = all cores
};

/// The result of registerScan() and registerMap().
struct GAUSSMAP_API RegistrationResult {
  Pose pose;  ///< scan frame to map frame
  /// Covariance of (x, y, z [m], rotation vector about the sensor [rad]) along the map's axes, from the last iteration.
  /// It is symmetric positive definite, or zero if the map gives no information about the pose.
  PoseCovariance covariance = PoseCovariance::Zero();
  /// The direction with the smallest information: a unit vector of (x, y, z, rotation vector times the RMS range of the
  /// scan). Zero if the map gives no information about the pose.
  PoseDirection least_observable = PoseDirection::Zero();
  double fitness = 0.0;       ///< share of the scan's Gaussians within 3 standard deviations of a map Gaussian
  double mean_squared = 0.0;  ///< mean squared Mahalanobis distance of these Gaussians
  int iterations = 0;         ///< of all steps
  bool converged = false;     ///< the last step ended before max_iterations
  bool degenerate = true;     ///< some direction is unobservable (along a corridor, on a plain), see `least_observable`
};

/// Registers a scan to a map: refines the guess of its pose, from the coarsest scale to the finest.
///
/// At every scale, each Gaussian of the scan is matched with the nearest Gaussian of the map. The covariances are
/// widened by a fraction of the side of the cells, first by more, then by less. The pose minimises the squared
/// Mahalanobis distances under a robust kernel (Geman-McClure), by damped Gauss-Newton iterations. A map Gaussian does
/// not constrain the pose along directions in which it fills its cell. A map Gaussian of the finest scale constrains it
/// mainly along its thinnest direction.
///
/// `points` are in the scan frame [m]; non-finite points are ignored. Throws std::invalid_argument if an option is out
/// of range (the message names it), the map is empty, or the guess has a fault (see poseFault()).
GAUSSMAP_API RegistrationResult registerScan(const std::vector<Eigen::Vector3d>& points, const GaussianMap<3>& map,
                                             const Pose& guess = {}, const RegistrationOptions& options = {});

/// Registers the map `source` to `map`, distribution to distribution. It works like registerScan(), with the Gaussians
/// of `source` instead of those of a scan. The resulting pose transforms the frame of `source` into that of `map`.
GAUSSMAP_API RegistrationResult registerMap(const GaussianMap<3>& source, const GaussianMap<3>& map,
                                            const Pose& guess = {}, const RegistrationOptions& options = {});

}  // namespace gaussmap
