// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// What could be read of a log of the robot software CARMEN.
struct CarmenLog {
  /// A line that was left out, or the place where the file stops being readable.
  struct Fault {
    std::size_t line = 0;  ///< from 1
    std::string what;
  };
  std::vector<LaserScan> scans;  ///< in the order of the file; the pose is the laser's, taken as exact
  std::vector<Fault> faults;     ///< in the order of the file, the first 1000
  std::size_t more_faults = 0;   ///< beyond these
};

/// Reads the planar laser's scans of a log, plain or gzip (told by the first bytes), lines
///   FLASER n ranges[n] x y heading ...
///   ROBOTLASER1 type start_angle field_of_view step max_range accuracy remission_mode n ranges[n] m remissions[m]
///               x y heading ...
/// Other lines are passed over. FLASER does not say its bearings: they follow from n as in CARMEN, for a SICK with 180
/// degrees (100 degrees for 400 or 401 beams) the first at half of that to the right, and the step is 180 / n degrees
/// for 180 and 360 beams, 180 / (n - 1) for others. Readings of 80 m and more are what a SICK writes for no return.
/// Damaged lines are left out and named; of a gzip file that was cut off or damaged all whole lines before the damage
/// are kept. Throws FileError if the file cannot be read or not one scan is left.
GAUSSMAP_API CarmenLog readCarmenLog(const std::filesystem::path& path);

/// True for names that end in .log or .clf, or one of these and .gz, in any case.
GAUSSMAP_API bool isCarmenLogName(const std::filesystem::path& name);

}  // namespace gaussmap
