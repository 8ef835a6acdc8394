// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>
#include "gaussmap/core/scans.h"

#include "gaussmap/core/gaussian.h"
#include "gaussmap/map/grid.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// The pose of a planar sensor: p_map = R(heading) p_sensor + translation.
struct GAUSSMAP_API Pose2 {
  Vector<2> translation{0.0, 0.0};  ///< position of the sensor [m], map frame
  double heading = 0.0;             ///< angle from the x axis of the map frame [rad], counter-clockwise
  /// Covariance of (x, y, heading) in the map frame [m, m, rad]; zero: the pose is exact.
  Matrix<3> covariance = Matrix<3>::Zero();

  /// Transforms a point from the sensor frame into the map frame [m].
  Vector<2> operator*(const Vector<2>& point) const {
    const double c = std::cos(heading), s = std::sin(heading);
    return Vector<2>(c * point.x() - s * point.y(), s * point.x() + c * point.y()) + translation;
  }
};

/// One sweep of a planar laser. The beams are in the order of their bearings.
struct LaserScan {
  Pose2 pose;                                 ///< sensor frame to map frame
  std::vector<double> bearings;               ///< per beam: bearing [rad], sensor frame, ascending
  std::vector<double> ranges;                 ///< per beam: range [m]; see returned()
  double max_range = 80.0;                    ///< limit of the ranges [m], see returned()
  std::optional<double> time = std::nullopt;  ///< time of the sweep [s]; std::nullopt if unknown

  /// Returns true if a beam has a return: its range is finite, above 0 and below max_range.
  bool returned(std::size_t beam) const {
    return std::isfinite(ranges[beam]) && ranges[beam] > 0.0 && ranges[beam] < max_range;
  }
  /// Returns the end of a beam that has a return [m, map frame].
  Vector<2> hit(std::size_t beam) const {
    return pose * Vector<2>(ranges[beam] * std::cos(bearings[beam]), ranges[beam] * std::sin(bearings[beam]));
  }
};

/// Options of planarScan(): which points of a cloud become the sweep of a planar laser.
struct GAUSSMAP_API PlanarScanOptions {
  bool slice = false;  ///< for 3-D clouds: uses only points with z_min <= z <= z_max, map frame
  /// Minimum height of a slice in the map frame [m].
  double z_min = 0.0, z_max = 0.0;  ///< maximum height of a slice in the map frame [m], >= z_min
  /// With `slice`: angle per beam [degrees], 0.01 to 180, rounded so that a whole number of beams fills the full turn.
  double step = 0.5;
  /// Points farther from the sensor are not returns [m]. The distance is measured in the xy plane of the map frame.
  double max_range = std::numeric_limits<double>::infinity();
  double min_range = 0.0;                     ///< points nearer to the sensor are not returns [m]
  std::optional<Box<3>> crop = std::nullopt;  ///< points outside this box are not returns [m, map frame]
};

/// Converts a cloud to a sweep of a planar laser. The points are projected along z of the map frame. The bearing of a
/// point is the angle from the x axis of the sensor. The pose of the sweep is exact: its covariance is zero.
///
/// - Without `slice`, each point is a beam. If all bearings ascend or all descend, by less than a full turn, the points
///   are already in the order of a sweep; a descending order is reversed. NaN points are then beams without a return,
///   with bearings between those of their neighbours. In any other case, NaN points are dropped and the points are
///   sorted by bearing. Some files leave out beams without a return. Therefore one such beam is inserted where two
///   beams are more than 1.5 times the median step apart.
/// - With `slice`, the full turn is divided into steps, with one beam per step. The beam measures the nearest point in
///   its step. Without such a point, it has no return.
///
/// Throws std::invalid_argument if an option is out of range. Without `slice`, it also throws if the heights of the
/// points differ by more than 0.5 m.
GAUSSMAP_API LaserScan planarScan(const Scan& cloud, const PlanarScanOptions& options = {});

/// Converts all scans to sweeps, in their order. Throws FileError if a file is damaged or planarScan() does not accept
/// a scan; the message gives the scan. Throws std::invalid_argument if an option is out of range.
GAUSSMAP_API std::vector<LaserScan> planarScans(const Scans& scans, const PlanarScanOptions& options = {});

}  // namespace gaussmap
