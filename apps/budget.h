// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common.h"
#include "gaussmap/mapping/error_curve.h"

namespace gaussmap::app {

/// How many Gaussians the coarse scales may have: the same words for every command that refines.
struct BudgetInput {
  double budget = RefineOptions().budget;
  std::vector<std::string> max_gaussians;  // "N" or "SCALE=N"
  std::string max_bytes;                   // with suffix k, M, G
  double max_error = 0.0;                  // [m], 0: not given
  std::string method = "agglomerate";
  std::optional<std::string> cost;   // of merges, --method agglomerate only
  std::optional<std::string> cells;  // which cells are served first, --method insert only
  RefineOptions refine;              // seed and threads
};
void addBudgetOptions(CLI::App& command, BudgetInput& input);

/// Checks the words that need no map. Throws UsageError.
void checkBudget(const BudgetInput& input);

/// The map within its budget. Adds the error curves to the metadata, and `step`, completed by the budget, to the
/// history; warns on stderr of scales that cannot reach --max-error.
GaussianMap<3> refineWithin(GaussianMap<3> map, const BudgetInput& input, MapMetadata& metadata, Json step);

}  // namespace gaussmap::app
