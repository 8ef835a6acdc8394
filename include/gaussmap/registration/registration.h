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
  /// The Gaussians of cells with this side represent the scan [m], > 0. 0: the side of the map's finest cells. The
  /// first steps use coarse scales of the map. If the cells of such a scale are wider than `resolution`, the scan is
  /// represented with cells of four times `resolution`. The last step always uses cells of `resolution`.
  double resolution = 0.0;
  /// Maximum number of Gaussians of the scan that a step uses, >= 1. If there are more, the step uses an even
  /// selection of them.
  std::size_t max_gaussians = 4000;
  int max_iterations = 30;  ///< maximum number of iterations per step, >= 1
  double kernel = 3.0;      ///< the robust kernel halves the cost of a residual of this many standard deviations, > 0
  /// The last step ends when an iteration moves the pose by at most this [m], > 0, and turns it by at most `rotation`.
  /// Infinity: only the other limit counts. Earlier steps can use larger limits: both are multiplied by the same
  /// factor.
  double translation = 5e-4;
  double rotation = 5e-5;  ///< limit of the turn, see `translation` [rad], > 0
  /// A direction of the pose is unobservable if the surfaces of the map give at most this share of the information that
  /// they give about the best direction, >= 0. See RegistrationResult::degenerate.
  double degenerate = 0.003;
  int threads = 0;  ///< 0 = all cores
};

/// The result of registerScan() and registerMap().
struct GAUSSMAP_API RegistrationResult {
  Pose pose;  ///< scan frame to map frame
  /// Covariance of (x, y, z [m], rotation vector about the sensor [rad]) along the map's axes, from the last iteration.
  /// It is symmetric positive definite, or zero if the map gives no information about the pose.
  ///
  /// Along an unobservable direction, the standard deviation is 1 rad for a rotation, and the RMS range of the scan for
  /// a translation [m]. The matrix can therefore be inverted, for example for a factor of a pose graph. Such a factor
  /// has almost no influence along this direction.
  PoseCovariance covariance = PoseCovariance::Zero();
  /// The direction in which the surfaces of the map constrain the pose least: a unit vector of (x, y, z, rotation
  /// vector times the RMS range of the scan). It is zero if the map gives no information about the pose.
  PoseDirection least_observable = PoseDirection::Zero();
  double fitness = 0.0;       ///< share of the scan's Gaussians within 3 standard deviations of a map Gaussian
  double mean_squared = 0.0;  ///< mean squared Mahalanobis distance of these Gaussians
  int iterations = 0;         ///< number of iterations of all steps together
  /// True: the last step ended because the pose no longer moved or improved. False: the last step reached
  /// RegistrationOptions::max_iterations, or the map gives no information about the pose. In the second case, `pose` is
  /// the guess.
  bool converged = false;
  /// True: some direction is unobservable (along a corridor, on a plain), see `least_observable`. Along all such
  /// directions, `pose` keeps the guess.
  bool degenerate = true;
};

/// Registers a scan to a map: refines the guess of its pose. It uses all scales of the map, from the coarsest to the
/// finest, with two steps per scale.
///
/// In each iteration, each Gaussian of the scan is matched with the nearest Gaussian of the map (Mahalanobis distance)
/// in the eight nearest cells. The covariances are widened. The added standard deviation is 0.3 times the side of the
/// map's cells in the first step of a scale, and 0.1 times in the second. The pose minimises the squared Mahalanobis
/// distances under a robust kernel (Geman-McClure), by damped Gauss-Newton iterations. A map Gaussian does not
/// constrain the pose along directions in which it fills its cell. At the finest scale, a map Gaussian constrains the
/// pose mainly along its thinnest direction.
///
/// At the end, the normals of the surfaces on which the scan lies show which directions of the pose are unobservable.
/// If there are any, the registration starts again from the guess and does not move the pose along them. The borders of
/// the mapped area and the scan lines of a lidar on a plane do not count as information. If fewer than three Gaussians
/// of the scan have a match in the map, or no match is a surface, the result is the guess.
///
/// `points` are in the scan frame [m]; non-finite points are ignored. Throws std::invalid_argument if an option is out
/// of range (the message names it), the map is empty, or the guess has a fault (see poseFault()).
GAUSSMAP_API RegistrationResult registerScan(const std::vector<Eigen::Vector3d>& points, const GaussianMap<3>& map,
                                             const Pose& guess = {}, const RegistrationOptions& options = {});

/// Registers the map `source` to `map`, distribution to distribution. It works like registerScan(), with the Gaussians
/// of `source` instead of those of a scan. Where registerScan() would build cells of some side, the scale of `source`
/// with the most similar side is used. If `source` is empty, the result is the guess. The resulting pose transforms the
/// frame of `source` into that of `map`.
GAUSSMAP_API RegistrationResult registerMap(const GaussianMap<3>& source, const GaussianMap<3>& map,
                                            const Pose& guess = {}, const RegistrationOptions& options = {});

/// Registers a scan to a planar map: refines x, y and the heading of the guess.
///
/// It works like registerScan() in space, with these differences:
/// - One search starts at each scale of the map. The result is the search with the smallest cost at the finest scale.
/// - `points` are in the scan frame [m]; non-finite points are ignored. The tilt of the guess (roll and pitch) is
///   applied to the points, and then they lose their height. To register a slice of a 3-D scan, pass only the points of
///   the slice.
/// - The result keeps z and the tilt of the guess. If the guess is a rotation about z, so is the result.
/// - In RegistrationResult::covariance and RegistrationResult::least_observable, the entries of z and of the rotations
///   about x and y are zero. RegistrationResult::degenerate is true if x, y or the heading is unobservable.
/// - RegistrationOptions::threads is not used.
///
/// Throws like registerScan() in space.
GAUSSMAP_API RegistrationResult registerScan(const std::vector<Eigen::Vector3d>& points, const GaussianMap<2>& map,
                                             const Pose& guess = {}, const RegistrationOptions& options = {});

/// Registers the planar map `source` to the planar map `map`. It works like registerScan() in the plane, with the
/// Gaussians of `source` as in registerMap() in space. It also throws std::invalid_argument if the guess is not planar
/// (z = 0, rotation about z). The resulting pose is therefore planar, and transformMap() accepts it.
GAUSSMAP_API RegistrationResult registerMap(const GaussianMap<2>& source, const GaussianMap<2>& map,
                                            const Pose& guess = {}, const RegistrationOptions& options = {});

}  // namespace gaussmap
