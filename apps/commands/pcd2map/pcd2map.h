// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands/budget.h"
#include "commands/map_task.h"
#include "commands/pcd2map/online_options.h"
#include "commands/scan_input.h"
#include "gaussmap/map/grid.h"

namespace gaussmap::app {

struct Pcd2mapOptions {
  ScanInput input;
  Output output;
  MapOptions map;
  BudgetInput budget;
  OnlineInput online;
  std::string update;                   // map file to add the scans to; empty: build a new one
  std::optional<double> update_budget;  // with `update`; not given: that of the map
  std::string max_memory;               // empty: no limit
  bool json = false;
};

/// What is said about a map that was written.
struct WrittenMap {
  PointCounts counts;
  Json scales = Json::array();
};

// Four ways from scans to a map. The first three write the output of `task`, with the history in it.

/// All scans at once, in memory.
WrittenMap buildInMemory(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
                         MapTask& task);

/// Tile by tile, through a temporary file. Gives the same map, without error curves.
WrittenMap buildWithinMemory(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading);
/// Throws UsageError for options that need the whole map in memory.
void checkMemory(const Pcd2mapOptions& options);

/// Scan by scan, with occupancy; writes the statistics and the deleted clusters if they are asked for.
WrittenMap buildOnline(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
                       MapTask& task);

/// Adds the scans to an existing map file and reports it.
void updateFromScans(const Pcd2mapOptions& options);

}  // namespace gaussmap::app
