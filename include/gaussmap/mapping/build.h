// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "gaussmap/core/scans.h"
#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/points/split_points.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Options of accumulateScans(), accumulateScansInParts() and readPoints().
struct GAUSSMAP_API AccumulateOptions {
  double resolution = 0.1;                                     ///< side of the cells [m]
  double max_range = std::numeric_limits<double>::infinity();  ///< points farther from the sensor are ignored [m]
  int threads = 0;                                             ///< 0 = all cores
  double min_range = 0.0;                                      ///< points nearer to the sensor are ignored [m]
  std::optional<Box<3>> crop = std::nullopt;                   ///< points outside this box are ignored [m, map frame]
};

/// The state of accumulateScans() after a scan.
struct AccumulateProgress {
  std::size_t scans_done = 0;  ///< number of scans read so far
  std::size_t scans = 0;       ///< number of all scans
  std::int64_t points = 0;     ///< number of points read so far
  std::size_t cells = 0;       ///< lower bound of the number of occupied cells: the cells that one thread has found
};
/// A function that receives the progress.
using ReportProgress = std::function<void(const AccumulateProgress&)>;

/// The result of accumulateScans().
template <int D = 3>
struct AccumulatedScans {
  /// A function that receives the moments of a part of the points, see accumulateScansInParts().
  using TakePart = std::function<void(const MomentGrid<D>&)>;

  MomentGrid<D> moments;  ///< exact moments per cell, map frame
  PointCounts counts;     ///< numbers of accepted and dropped points
};

/// Reads scans and sorts their points into cells. The memory grows with the map, not with the number of scans.
///
/// For D = 2, the accepted points are transformed into the map frame and lose their z coordinate there. Use
/// AccumulateOptions::crop to select a horizontal slice of a 3-D scan. The range limits apply to the distance in space.
///
/// `progress` is called after every scan, one call at a time. Throws:
/// - FileError if a file is damaged
/// - std::out_of_range if a point lies beyond the range of the cell indices; the message gives the scan and the point
/// - std::invalid_argument if an option is out of range; the message names the option
template <int D = 3>
GAUSSMAP_API AccumulatedScans<D> accumulateScans(const Scans& scans, const AccumulateOptions& options,
                                                 const ReportProgress& progress = {});

/// Reads scans and sorts their points into cells, within limited memory.
///
/// Each thread sorts points into its own grid. All grids together use at most about `max_bytes`. If the grid of a
/// thread exceeds its share of this, the thread passes the grid to `take` and continues with an empty grid. At the end,
/// the remaining grids are passed to `take`. The calls of `take` do not overlap and have no fixed order. Each accepted
/// point is in exactly one of the grids. Throws like accumulateScans().
template <int D = 3>
GAUSSMAP_API PointCounts accumulateScansInParts(const Scans& scans, const AccumulateOptions& options,
                                                std::size_t max_bytes,
                                                const typename AccumulatedScans<D>::TakePart& take,
                                                const ReportProgress& progress = {});

/// Returns the accepted points of all scans, in their order [m, map frame]. A map can be compared with these points.
/// For D = 2, the points lose their z coordinate as in accumulateScans(). AccumulateOptions::resolution and
/// AccumulateOptions::threads are not used. Throws FileError if a file is damaged, and std::invalid_argument like
/// accumulateScans().
template <int D = 3>
GAUSSMAP_API std::vector<Vector<D>> readPoints(const Scans& scans, const AccumulateOptions& options);

/// Builds the map from moments per cell, with one Gaussian per cell at every scale.
///
/// The cells are sorted into key order. Every coarser scale is the moment match of the finer one, Yguel 2009 eqs. (9),
/// (10). Throws std::invalid_argument if the options are not usable or the resolutions of the grid and the options
/// differ.
template <int D>
GAUSSMAP_API GaussianMap<D> build(const MomentGrid<D>& grid, const MapOptions& options);

/// Builds the map from points [m, map frame], with one Gaussian per cell at every scale. Non-finite points are ignored.
/// Throws std::invalid_argument if the options are not usable, and std::out_of_range if a point lies beyond the range
/// of 32-bit cell indices; the message gives the point.
template <int D>
GAUSSMAP_API GaussianMap<D> build(const std::vector<Vector<D>>& points, const MapOptions& options);

/// Builds the map from the Gaussians of its finest scale, for example of an imported map. The map gets one Gaussian per
/// cell at every scale.
///
/// The function uses only MapScale::keys and MapScale::gaussians of `finest`. There must be one Gaussian per key; the
/// cells can have any order. The function sorts the cells into key order, builds the coarser scales, and links the
/// Gaussians to their parents. Throws std::invalid_argument if `finest` is not a valid scale; the message gives the
/// reason.
template <int D>
GAUSSMAP_API GaussianMap<D> build(const MapScale<D>& finest, const MapOptions& options);

/// Builds the map from scans, with one Gaussian per cell at every scale.
///
/// For D = 2, points lose their z coordinate as in accumulateScans(). The resolution of `options` replaces that of
/// `reading`. If `counts` is given, it receives the numbers of accepted and dropped points. Throws like
/// accumulateScans() and build() from moments.
template <int D = 3>
GAUSSMAP_API GaussianMap<D> build(const Scans& scans, const MapOptions& options = {}, AccumulateOptions reading = {},
                                  PointCounts* counts = nullptr);

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
/// cell
///    are summed.
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
