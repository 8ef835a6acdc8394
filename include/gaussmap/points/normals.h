// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "gaussmap/core/scans.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// A view of memory for normals that the caller owns. Each record holds a normal (three floats) and a curvature.
struct NormalsView {
  float* normal = nullptr;     ///< x of the first normal
  float* curvature = nullptr;  ///< first curvature
  std::size_t stride = 4;      ///< floats from one record to the next
};

/// Options of pointNormals().
struct GAUSSMAP_API PointNormalOptions {
  /// Minimum number of points per plane (if the cloud has that many), 3 to 1000. On average a plane has 1.5 times as
  /// many.
  int min_points = 14;
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();  ///< normals point towards it [m]
  int threads = 0;                                      ///< 0 = all cores
};

/// Computes the surface normal at each query point and returns the number of queries without a normal.
///
/// The normal is that of the Gaussian of all surface points in a block of cells around the query. The function takes
/// the finest block with at least min_points points, or all points if the cloud has fewer. The cells are those of an
/// octree. Blocks are 3 or 5 cells wide; in a block of 5, a cell is two off the middle along at most one axis. A block
/// is therefore at most 1.8 times as wide as the next finer one. The function does not search for neighbours: it needs
/// one sort, one sum per cell, and one plane per block.
///
/// The curvature is the smallest variance divided by the sum of all three, 0 to 1/3, as in PCL. Query i writes record i
/// of `normals`: a unit normal and the curvature. The record is NaN if the query is not finite or the points of its
/// block lie on a line. Non-finite surface points are ignored.
///
/// Cells are not split below 2^-21 of the extent of the cloud. At both ends of each axis, the outermost 1 % of the
/// points does not count for this extent if it lies far away. Throws std::invalid_argument if an option is out of range
/// (the message names it) or there are 2^31 points or more.
GAUSSMAP_API std::size_t pointNormals(const PointsView& surface, const PointsView& queries, const NormalsView& normals,
                                      const PointNormalOptions& options = {});

}  // namespace gaussmap
