// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/map/moment_grid.h"

namespace gaussmap {

/// A PCD file and where its sensor stood.
struct ScanSource {
  std::filesystem::path path;
  Pose pose;  ///< unit quaternion
};

/// The frame that the coordinates in the files are in.
enum class ScanFrame {
  Sensor,  ///< of the sensor: the pose moves points into the map
  Map      ///< of the map already: the pose only tells ranges from, its rotation is not used
};

struct AccumulateOptions {
  double resolution = 0.1;  ///< side of the cells [m]
  ScanFrame frame = ScanFrame::Sensor;
  double max_range = std::numeric_limits<double>::infinity();  ///< farther points are left out [m]
  int threads = 0;                                             ///< 0 = all; never shows in the result
};

/// Where the points went; the four kinds add up to `read`.
struct PointCounts {
  std::int64_t read = 0;
  std::int64_t accepted = 0;
  std::int64_t non_finite = 0;
  std::int64_t at_sensor = 0;  ///< at range 0, as some drivers mark 'no return' (frame Sensor only)
  std::int64_t beyond_range = 0;
};

struct AccumulateProgress {
  std::size_t scans_done = 0;
  std::size_t scans = 0;
  std::int64_t points = 0;
  std::size_t cells = 0;  ///< of the thread that reports, so a lower bound
};

struct AccumulatedScans {
  MomentGrid<3> moments;
  PointCounts counts;
};

/// Reads scans one after the other and counts their points into cells: memory grows with the map, not with the scans.
/// The sums are exact, so order and threads do not matter. `progress` is called after every scan, one call at a time.
/// Throws FileError for a damaged file; std::out_of_range, naming file and point, for a point too far for the cells;
/// std::invalid_argument, naming the option.
AccumulatedScans accumulateScans(const std::vector<ScanSource>& scans, const AccumulateOptions& options,
                                 const std::function<void(const AccumulateProgress&)>& progress = {});

/// The same within limited memory: the sums of a thread are handed over whenever all threads together may hold more
/// than `most_bytes` of them, and at the end. One call of `take` at a time, in no fixed order; each point is in one of
/// them.
PointCounts accumulateScansInParts(const std::vector<ScanSource>& scans, const AccumulateOptions& options,
                                   std::size_t most_bytes, const std::function<void(const MomentGrid<3>&)>& take,
                                   const std::function<void(const AccumulateProgress&)>& progress = {});

/// The accepted points of scans, in their order [m, map frame]: the reference that a map is compared with.
std::vector<Vector<3>> readScans(const std::vector<ScanSource>& scans, const AccumulateOptions& options);

}  // namespace gaussmap
