// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "commands/budget.h"
#include "commands/map_task.h"
#include "commands/pcd2map/online_options.h"
#include "commands/planar_input.h"
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
  std::optional<double> update_budget;  // with `update`; nullopt: the budget of the map
  std::string max_memory;               // empty: no limit
  bool planar = false;                  // build a planar map
  Slice slice;                          // of 3-D scans, for a planar map
  bool json = false;
};

/// The counts of a map that was written, for the report.
struct WrittenMap {
  PointCounts counts;
  Json scales = Json::array();
};

// Four ways to turn scans into a map of D dimensions. The first three write the output file of the command, with its
// history.

/// Builds the map in memory.
template <int D>
WrittenMap buildInMemory(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
                         MapTask& task);

/// Builds the map tile by tile, with a temporary file. The map is the same, but without error curves.
template <int D>
WrittenMap buildWithinMemory(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
                             const MapTask& task);
/// Throws UsageError if --max-memory is combined with options that need the whole map in memory.
void checkMemory(const Pcd2mapOptions& options);

/// Builds the map scan by scan, with occupancy. Writes the statistics and the deleted clusters if --stats and --removed
/// are given.
template <int D>
WrittenMap buildOnline(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
                       MapTask& task);

/// Adds the scans to an existing map file and prints a report. Throws UsageError if options do not suit its dimension.
void updateFromScans(const Pcd2mapOptions& options);

}  // namespace gaussmap::app
