// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>
#include "gaussmap/core/scans.h"

#include "gaussmap/map/gaussian_map.h"
#include "gaussmap/map/moment_grid.h"
#include "gaussmap/version.h"

namespace gaussmap {

struct GAUSSMAP_API AccumulateOptions {
  double resolution = 0.1;                                     ///< side of the cells [m]
  double max_range = std::numeric_limits<double>::infinity();  ///< farther points are left out [m]
  int threads = 0;                                             ///< 0 = all; does not change the result
};

struct AccumulateProgress {
  std::size_t scans_done = 0;
  std::size_t scans = 0;
  std::int64_t points = 0;
  std::size_t cells = 0;  ///< of the thread that reports, so a lower bound
};
using ReportProgress = std::function<void(const AccumulateProgress&)>;

struct AccumulatedScans {
  MomentGrid<3> moments;
  PointCounts counts;
};

/// Reads scans one after the other and counts their points into cells: memory grows with the map, not with the scans.
/// The sums are exact, so order and threads do not matter. `progress` is called after every scan, one call at a time.
/// Throws FileError for a damaged file; std::out_of_range, naming scan and point, for a point too far for the cells;
/// std::invalid_argument, naming the option.
GAUSSMAP_API AccumulatedScans accumulateScans(const Scans& scans, const AccumulateOptions& options,
                                              const ReportProgress& progress = {});

/// The same within limited memory: a thread hands its sums over whenever all threads together may hold more than
/// `max_bytes` of them, and at the end. One call of `take` at a time, in no fixed order; each point is in exactly one
/// of the grids.
GAUSSMAP_API PointCounts accumulateScansInParts(const Scans& scans, const AccumulateOptions& options,
                                                std::size_t max_bytes,
                                                const std::function<void(const MomentGrid<3>&)>& take,
                                                const ReportProgress& progress = {});

/// The accepted points of scans, in their order [m, map frame]: the reference that a map is compared with.
/// options.resolution is not used.
GAUSSMAP_API std::vector<Vector<3>> readPoints(const Scans& scans, const AccumulateOptions& options);

/// Cells of moments -> the whole map: sorts them into key order, then makes every coarser scale from the finer one
/// by moment matching (Yguel 2009, eqs. (9), (10)), one Gaussian per cell. Points are not touched again.
/// Throws std::invalid_argument if the grid's resolution is not the options'.
template <int D>
GAUSSMAP_API GaussianMap<D> build(const MomentGrid<D>& grid, const MapOptions& options);

/// Points [m, map frame] -> map. Non-finite points are left out. Throws std::out_of_range, naming the point, if one
/// is too far for 32-bit cells.
template <int D>
GAUSSMAP_API GaussianMap<D> build(const std::vector<Vector<D>>& points, const MapOptions& options);

/// The coarser scales for a finest scale that is given as plain cells of Gaussians (an imported map), in any order.
/// Sets keys, Gaussians and links. Throws std::invalid_argument, saying what, if the cells are no scale.
template <int D>
GAUSSMAP_API GaussianMap<D> build(const MapScale<D>& finest, const MapOptions& options);

/// Scans -> map, one Gaussian per cell at every scale. options.resolution replaces that of `reading`. `counts`, if
/// given, says where the points went. Throws as accumulateScans() and build().
GAUSSMAP_API GaussianMap<3> build(const Scans& scans, const MapOptions& options = {}, AccumulateOptions reading = {},
                                  PointCounts* counts = nullptr);

}  // namespace gaussmap
