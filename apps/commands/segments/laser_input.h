// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "commands/scan_input.h"
#include "common/command.h"
#include "gaussmap/segments/laser_scan.h"

namespace gaussmap::app {

/// Sweeps of a planar laser, from CARMEN logs or from PCD scans.
struct LaserInput {
  ScanInput scans;
  std::vector<double> slice;    // z0 z1, or empty
  double position_noise = 0.0;  // of every pose [m]
  double heading_noise = 0.0;   // [rad]
};

/// Adds the positional IN... and the options that say how they are read.
void addLaserOptions(Command& command, LaserInput& input);

struct LaserScans {
  std::vector<LaserScan> scans;
  std::vector<std::string> names;            // one per scan: its file, or "file:n" for the n-th scan of a log
  std::vector<std::filesystem::path> files;  // that were read
};

/// Warns of damaged lines of logs on stderr. Throws UsageError if logs and PCD scans are mixed, or if options do not go
/// with logs.
LaserScans readLaserScans(const LaserInput& input);

}  // namespace gaussmap::app
