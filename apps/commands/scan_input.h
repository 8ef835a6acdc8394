// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/io/scans/pcd_scans.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap::app {

/// Which clouds, and how they lie in the map: the same options for every command that reads scans.
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

/// findScans(); its warnings go to stderr.
PcdScans openScans(const ScanInput& input);
AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads);
/// All points of the scans in the map frame. Throws if there are none.
std::vector<Vector<3>> readPoints(const ScanInput& input, int threads);

/// "scan.pcd", or "scan.pcd and 4 more".
std::string nameOf(const Scans& scans);

}  // namespace gaussmap::app
