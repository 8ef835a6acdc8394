// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "gaussmap/core/scans.h"
#include "gaussmap/segments/laser_scan.h"

namespace gaussmap {

/// What of a cloud of points becomes the sweep of a planar laser.
struct PlanarScanOptions {
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
LaserScan planarScan(const Scan& cloud, const PlanarScanOptions& options = {});

/// The same for all scans, in their order. Throws FileError, naming the scan, for a damaged file or points in no plane.
std::vector<LaserScan> planarScans(const Scans& scans, const PlanarScanOptions& options = {});

}  // namespace gaussmap
