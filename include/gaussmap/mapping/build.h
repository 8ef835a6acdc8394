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

}  // namespace gaussmap
