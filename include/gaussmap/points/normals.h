// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "gaussmap/core/scans.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Where normals go: three floats and a curvature a record, a record every `stride` floats.
struct NormalsView {
  float* normal = nullptr;
  float* curvature = nullptr;
  std::size_t stride = 4;
};

struct GAUSSMAP_API PointNormalOptions {
  int min_points = 14;  ///< a plane goes through at least so many points (if there are), on average half as many more;
                        ///< 3 ... 1000
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();  ///< normals look towards it [m]
  int threads = 0;                                      ///< 0 = all; never shows in the result
};

/// The normal of a surface at each query: that of the Gaussian of the points in the finest block of cells around it
/// that holds min_points of them. Blocks are 3 and 5 cells wide (of the latter only cells at most one off in two of the
/// axes), cells those of an octree, so that a block is at most 1.8 times as wide as the next finer one. No search for
/// neighbours: one sort, one sum a cell, one plane a block. If all points together are fewer, the plane is theirs.
/// The curvature is the share of the least variance in the sum of the three, 0 ... 1/3, as PCL has it.
///
/// Query i writes record i of `normals`: unit normal and curvature, or NaN if the query is not finite or the points of
/// its block lie on a line. Non-finite points of the surface do not count. Returns how many queries have no normal.
/// Cells are not split below 2^-21 of the extent of the cloud; the outermost hundredth of the points at either end of
/// an axis does not count for that extent if it lies far off.
/// Throws std::invalid_argument, naming the option, and for 2^31 points or more.
GAUSSMAP_API std::size_t pointNormals(const PointsView& surface, const PointsView& queries, const NormalsView& normals,
                                      const PointNormalOptions& options = {});

}  // namespace gaussmap
