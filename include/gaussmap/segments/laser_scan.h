// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <vector>
#include "gaussmap/core/scans.h"

#include "gaussmap/core/gaussian.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Pose of a planar sensor: p_map = R(heading) p_sensor + translation.
struct GAUSSMAP_API Pose2 {
  Vector<2> translation{0.0, 0.0};  ///< [m], map frame
  double heading = 0.0;             ///< [rad], counter-clockwise
  /// Of (x, y, heading) in the map frame [m, m, rad]; zero: the pose is exact.
  Matrix<3> covariance = Matrix<3>::Zero();

  Vector<2> operator*(const Vector<2>& point) const {
    const double c = std::cos(heading), s = std::sin(heading);
    return Vector<2>(c * point.x() - s * point.y(), s * point.x() + c * point.y()) + translation;
  }
};

/// One sweep of a planar laser in the order of its bearings, so that neighbours in the vectors are neighbouring beams.
struct LaserScan {
  Pose2 pose;
  std::vector<double> bearings;  ///< n [rad], sensor frame, ascending
  std::vector<double> ranges;    ///< n [m]; not finite, <= 0 or >= max_range: no return
  double max_range = 80.0;       ///< [m]

  bool returned(std::size_t beam) const {
    return std::isfinite(ranges[beam]) && ranges[beam] > 0.0 && ranges[beam] < max_range;
  }
  /// End of a beam that returned [m], map frame.
  Vector<2> hit(std::size_t beam) const {
    return pose * Vector<2>(ranges[beam] * std::cos(bearings[beam]), ranges[beam] * std::sin(bearings[beam]));
  }
};

/// What of a cloud of points becomes the sweep of a planar laser.
struct GAUSSMAP_API PlanarScanOptions {
  bool slice = false;               ///< the cloud is three-dimensional: only points with z_min <= z <= z_max count
  double z_min = 0.0, z_max = 0.0;  ///< heights in the map frame [m]
  double step = 0.5;                ///< of a slice: degrees of bearing in which only the nearest point counts
  double max_range = std::numeric_limits<double>::infinity();  ///< [m]
};

/// Turns a cloud into a sweep: the points are projected along z of the map frame, bearings are counted from the
/// sensor's x axis. The pose is taken as exact. The points of a planar laser keep their order if their bearings ascend,
/// or descend, all along (beyond pi too, by less than a full turn); NaN points are then beams without a return, their
/// bearings between those of their neighbours. Otherwise the points are sorted. Where two beams lie more than one and a
/// half usual steps apart, a beam without a return stands between them: the file left it out. A slice has one beam for
/// each `step` of the full turn: the nearest point in it, or no return. Throws std::invalid_argument without a slice
/// for points that lie in no plane (more than 0.5 m apart in height), and unless z_min <= z_max and 0.01 <= step <=
/// 180.
GAUSSMAP_API LaserScan planarScan(const Scan& cloud, const PlanarScanOptions& options = {});

/// The same for all scans, in their order. Throws FileError, naming the scan, for a damaged file or points in no plane.
GAUSSMAP_API std::vector<LaserScan> planarScans(const Scans& scans, const PlanarScanOptions& options = {});

}  // namespace gaussmap
