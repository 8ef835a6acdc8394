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
/// The normal is the direction in which the surface points in a block of cells around the query vary least. The cells
/// are those of an octree. A block is a cube of 3 x 3 x 3 cells, or of 5 x 5 x 5 cells without those along the edges of
/// the cube. A block is therefore at most 5/3 times as wide as the next finer one. From coarse to fine, the function
/// tests blocks of 3 until one has fewer than 2.5 min_points points, because finer ones rarely have enough. It takes
/// this block, the block of 5 around it, or the last block of 3 before it: the finest with at least min_points points.
/// If the cloud has fewer, it takes all points. It does not search for neighbours: it needs one sort, one sum per cell,
/// and one plane per block.
///
/// The curvature is the smallest variance divided by the sum of all three, 0 to 1/3, as in PCL. Query i writes record i
/// of `normals`: a unit normal and the curvature. The record is NaN if the query is not finite or the points of its
/// block lie on a line. Non-finite surface points are ignored.
///
/// Cells are not split below 2^-21 of the extent of the cloud. Outliers do not widen this extent much: if the cloud is
/// over 210 times as wide as its part without the outermost 1 % of the points at both ends of each axis, the extent is
/// 21 times the width of this part. Throws std::invalid_argument if an option is out of range
/// (the message names it) or there are 2^31 points or more.
GAUSSMAP_API std::size_t pointNormals(const PointsView& surface, const PointsView& queries, const NormalsView& normals,
                                      const PointNormalOptions& options = {});

}  // namespace gaussmap
