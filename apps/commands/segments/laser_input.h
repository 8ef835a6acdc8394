// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "commands/scan_input.h"
#include "common/command.h"
#include "gaussmap/segments/laser_scan.h"

namespace gaussmap::app {

/// Options for the scans of a planar laser, from CARMEN logs or from PCD files.
struct LaserInput {
  ScanInput scans;
  std::vector<double> slice;    // z0 z1, or empty
  double position_noise = 0.0;  // standard deviation of every pose in x and y [m]
  double heading_noise = 0.0;   // standard deviation of every heading [rad]
};

/// Adds the positional argument of the inputs and the options for reading them.
void addLaserOptions(Command& command, LaserInput& input);

struct LaserScans {
  std::vector<LaserScan> scans;
  std::vector<std::string> names;            // one per scan: its file, or "FILE:N" for scan N of a log, from 0
  std::vector<std::filesystem::path> files;  // the input files
};

/// Reads the scans. Warns of damaged lines of logs on stderr. Throws UsageError if logs and PCD scans are mixed, or if
/// an option does not apply to logs.
LaserScans readLaserScans(const LaserInput& input);

}  // namespace gaussmap::app
