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

/// The readable content of a log of the robot software CARMEN.
struct CarmenLog {
  /// A line that was skipped, or the place where the file becomes unreadable.
  struct Fault {
    std::size_t line = 0;  ///< line number, from 1
    std::string what;      ///< description of the problem
  };
  std::vector<LaserScan> scans;  ///< in the order of the file; the pose of the laser has no covariance
  std::vector<Fault> faults;     ///< the first 1000, in the order of the file
  std::size_t more_faults = 0;   ///< number of further faults
};

/// Reads the scans of the planar laser from a log, plain or gzip (detected by the first bytes).
///
/// These lines are read, all others are ignored:
///
///     FLASER n ranges[n] x y heading ...
///     ROBOTLASER1 type start_angle field_of_view step max_range accuracy remission_mode n ranges[n]
///                 m remissions[m] x y heading ...
///
/// FLASER does not give the bearings. They follow from n as in CARMEN, for a SICK laser with a field of view of 180
/// degrees (100 degrees for 400 or 401 beams). The first beam points to the right: its bearing is minus
/// half of the field of view. The step is the field of view divided by n for 180, 360 and 400 beams, and divided by n -
/// 1 for other numbers. Without a return, a SICK writes a range of about 81.8 m. LaserScan::max_range is therefore 80 m
/// for such lasers.
///
/// The time of a sweep [s] is the timestamp of its message: the third word from the end of the line. CARMEN often
/// writes it with only six digits, so many sweeps have the same time. If a line has no time, LaserScan::time is
/// std::nullopt.
///
/// Damaged lines are skipped and listed in CarmenLog::faults. If a gzip file is truncated or damaged, all whole lines
/// before the damage are kept. Throws FileError if the file cannot be read or holds no usable scan. To limit the
/// memory, it also throws FileError if the lines with scans take more than 16 MiB plus 100 times the size of the file.
GAUSSMAP_API CarmenLog readCarmenLog(const std::filesystem::path& path);

/// Returns true if a file name ends in .log, .clf, .log.gz or .clf.gz, in upper or lower case.
GAUSSMAP_API bool isCarmenLogName(const std::filesystem::path& name);

}  // namespace gaussmap
