// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "budget.h"
#include "common.h"

namespace gaussmap::app {

/// pcd2map --update: adds scans to an existing map file.
struct UpdateInput {
  std::string map;               // "": not asked for
  std::optional<double> budget;  // nothing: that of the map
};

void updateFromScans(const UpdateInput& input, const ScanInput& scans, const BudgetInput& budget, bool json);

}  // namespace gaussmap::app
