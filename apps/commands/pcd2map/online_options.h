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
  bool keep = false;    // delete nothing
  std::string stats;    // CSV file
  std::string removed;  // PCD file
};
void addOnlineOptions(Command& command, OnlineInput& input);

/// Throws UsageError for options that on-line mapping does not have, or outputs that cannot be written. `map` is the
/// main output.
void checkOnline(const OnlineInput& input, const BudgetInput& budget, const Output& map,
                 const std::vector<std::filesystem::path>& inputs);

/// The options of the mapper, with those of all commands.
OnlineOptions onlineOptions(const OnlineInput& input, const MapOptions& map, const AccumulateOptions& reading,
                            const BudgetInput& budget);

}  // namespace gaussmap::app
