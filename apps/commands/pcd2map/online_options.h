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
  bool as_in_paper = false;         // the options are those of the paper, unless others are given
  std::vector<double> depth_noise;  // empty: that of the kind of sensor
  bool keep = false;                // delete nothing
  std::string stats;                // CSV file
  std::string removed;              // PCD file
};
/// `as_in_paper`: the option --as-in-paper, which needs --online too.
void addOnlineOptions(Command& command, OnlineInput& input, const Option& as_in_paper);

/// Throws UsageError for options that on-line mapping does not support, and for outputs that cannot be written. `map`
/// is the main output, `resolution` the side of its finest cells [m].
void checkOnline(const OnlineInput& input, const BudgetInput& budget, double resolution, const Output& map,
                 const std::vector<std::filesystem::path>& inputs);

/// Returns the options of the mapper, including those that other options of the command set.
OnlineOptions onlineOptions(const OnlineInput& input, const MapOptions& map, const AccumulateOptions& reading,
                            const BudgetInput& budget);

}  // namespace gaussmap::app
