// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/io/scans/pcd_scans.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap::app {

/// The scans and their frame: the options that all commands that read scans share.
struct ScanInput {
  std::vector<std::string> paths;
  std::string poses;
  std::string frame = "sensor";
  double max_range = 0.0;  // 0: no limit
};
/// Adds the positional argument of the paths.
void addScanPaths(Command& command, ScanInput& input);
/// Adds --poses, --frame and --max-range.
void addScanOptions(Command& command, ScanInput& input);

/// Calls findScans() and prints its warnings on stderr. For a command that follows the rays of the sensor,
/// `follows_rays` is its name; the function then calls requireSensorPositions() before it warns.
PcdScans openScans(const ScanInput& input, const char* follows_rays = nullptr);
AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads);
/// Returns all points of the scans [m, map frame]. Throws std::runtime_error if no point is usable.
std::vector<Vector<3>> readPoints(const ScanInput& input, int threads);

/// The name of the scans in messages: "scan.pcd", or "scan.pcd and 4 more".
std::string nameOf(const Scans& scans);

}  // namespace gaussmap::app
