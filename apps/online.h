// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "budget.h"
#include "common.h"
#include "gaussmap/mapping/online/online_mapper.h"

namespace gaussmap::app {

/// Mapping scan by scan: the options of pcd2map --online.
struct OnlineInput {
  bool on = false;
  OnlineOptions options;
  double no_return_is_free = 0.0;  // [m], 0: not given
  bool keep = false;               // forget nothing
  std::string stats;               // CSV file
  std::string removed;             // PCD file
};
void addOnlineOptions(CLI::App& command, OnlineInput& input);

/// Throws UsageError on what mapping on line cannot do, or outputs that cannot be written. `map` is the main output.
void checkOnline(const OnlineInput& input, const BudgetInput& budget, const Output& map,
                 const std::vector<std::filesystem::path>& inputs);

struct OnlineResult {
  GaussianMap<3> map;
  PointCounts counts;
  std::size_t deleted = 0;  // clusters of all scales
};

/// Takes in the scans one by one; writes the statistics and the deleted clusters where they are asked for.
OnlineResult mapOnline(const Scans& scans, const OnlineInput& input, const MapOptions& map,
                       const AccumulateOptions& reading, const BudgetInput& budget);

}  // namespace gaussmap::app
