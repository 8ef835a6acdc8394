// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "commands/budget.h"
#include "common/command.h"
#include "gaussmap/mapping/online/online_mapper.h"

namespace gaussmap::app {

/// The options of pcd2map --online.
struct OnlineInput {
  bool on = false;
  OnlineOptions options;
  std::vector<double> depth_noise;  // empty: that of the kind of sensor
  bool keep = false;                // delete nothing
  std::string stats;                // CSV file
  std::string removed;              // PCD file
};
void addOnlineOptions(Command& command, OnlineInput& input);

/// Throws UsageError for options that on-line mapping does not support, and for outputs that cannot be written. `map`
/// is the main output.
void checkOnline(const OnlineInput& input, const BudgetInput& budget, const Output& map,
                 const std::vector<std::filesystem::path>& inputs);

/// Returns the options of the mapper, including those that other options of the command set.
OnlineOptions onlineOptions(const OnlineInput& input, const MapOptions& map, const AccumulateOptions& reading,
                            const BudgetInput& budget);

}  // namespace gaussmap::app
