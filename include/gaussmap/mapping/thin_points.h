// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gaussmap/core/cell_moments.h"
#include "gaussmap/core/gaussian.h"
#include "gaussmap/core/scans.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/grid.h"
#include "gaussmap/points/split_points.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of thinPoints(). If none of max_gaussians, max_error and leaf_size is set, the limit is 10,000 Gaussians.
struct ThinPointsOptions {
  std::optional<std::size_t> max_gaussians;  ///< maximum number of Gaussians, >= 1; std::nullopt: see above
  /// If > 0: 95 % of the points must be at most this far [m] from the point that represents their Gaussian, see
  /// `part_point`. The function searches for the smallest number of Gaussians with this property, to within 2 %.
  /// max_gaussians comes first: the error can then be larger, see ThinnedPoints::error_kept. If 0: there is no such
  /// limit.
  double max_error = 0.0;
  /// If > 0: side of the cells of scale 0 [m]. Without max_gaussians and max_error, every occupied cell of `scale`
  /// gives one Gaussian. If 0: the function chooses the cells from the other limits.
  double leaf_size = 0.0;
  int scale = 0;                           ///< cells of leaf_size * 2^scale are used, in [0, 19]; needs leaf_size
  PartPoint part_point = PartPoint::Mean;  ///< the point that represents a Gaussian, for max_error and the error
};

/// The result of thinPoints(): the Gaussians that represent the points of a cloud, and the cells from which they were
/// made.
struct GAUSSMAP_API ThinnedPoints {
  std::vector<std::int32_t> labels;  ///< per point: index of its Gaussian; -1 if the point is not finite
  /// Mean, covariance and number of points, in the frame of the points. The covariance is the sum of squares divided by
  /// the number of points, without noise, so it can be singular. The Gaussians are sorted by the Morton code of their
  /// first cell. The order of the points does not matter.
  std::vector<Gaussian<3>> gaussians;
  std::vector<std::uint32_t> samples;      ///< per Gaussian: index of the point nearest to its mean
  double error = 0.0;                      ///< 95 % of the points lie within this distance, see ThinPointsOptions [m]
  bool error_kept = true;                  ///< false if `error` is larger than ThinPointsOptions::max_error
  double cell_side = 1.0;                  ///< side of the cells [m]
  std::vector<CellKey<3>> keys;            ///< the occupied cells
  std::vector<CellMoments<3>> moments;     ///< per cell: the exact moments of its points
  std::vector<std::uint32_t> cell_labels;  ///< per cell: index of its Gaussian

  /// Returns the map of these cells, with two scales. Scale 0 has the cells and their moments. Scale 1 has `gaussians`,
  /// as the parents of the Gaussians of scale 0.
  ///
  /// A cell of scale 1 is at least as large as the cloud. A Gaussian whose finest cells lie in several cells of scale 1
  /// is divided into one part per cell. MapOptions::ratio is a power of two. MapOptions::noise is added to the
  /// covariances of the map, but not to those of `gaussians`.
  GaussianMap<3> map() const;
};

/// Represents the points of a cloud [m] by few Gaussians.
///
/// 1. The points are sorted into cells: 1.35 to about 8 cells per Gaussian of the result. The exact moments of each
///    cell are summed.
/// 2. Cells that are near each other are merged into clusters. The next merge is always the one that increases the sum
///    of squared distances between points and means least (Ward 1963). Only pairs within the same octree node of at
///    most 64 cells are considered. This step stops at 1.2 times the final number of clusters.
/// 3. The clusters are merged in the same way, within larger octree nodes, until the final number is reached.
///
/// The result does not depend on the order of the points, with one exception: if several points are equally near to a
/// mean, ThinnedPoints::samples takes the one with the smallest index. The function uses one thread. Its cost grows
/// like that of sorting the points. Points that are not finite are ignored.
///
/// Throws std::invalid_argument if an option is out of range; the message names it. Throws std::out_of_range if
/// leaf_size is smaller than about 1/500,000 of the extent of the points, or too small for their distance from the
/// origin.
GAUSSMAP_API ThinnedPoints thinPoints(const PointsView& points, const ThinPointsOptions& options = {});

}  // namespace gaussmap
