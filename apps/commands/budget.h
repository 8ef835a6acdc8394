// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/command.h"
#include "common/json.h"
#include "gaussmap/mapping/refine.h"

namespace gaussmap::app {

/// How many Gaussians the coarse scales may have: the same options for every command that refines.
struct BudgetInput {
  double budget = PerCell().gaussians;
  std::vector<std::string> max_gaussians;  // "N" or "SCALE=N"
  std::string max_bytes;                   // with suffix k, M, G
  double max_error = 0.0;                  // [m], 0: not given
  std::string method = "agglomerate";
  std::optional<std::string> cost;  // of merges, --method agglomerate only
  RefineOptions refine;             // seed and threads
  bool curves = true;               // measure what other budgets would give
};
void addBudgetOptions(Command& command, BudgetInput& input);
/// Two parts of these, for commands that only merge clusters: the budgets, and --cost. Returns --budget.
Option addLimitOptions(Command& command, BudgetInput& input);
void addCostOption(Command& command, BudgetInput& input);

/// A whole number > 0, with an optional suffix k, M or G (powers of 1000) behind it. Throws UsageError, naming the
/// option.
std::uintmax_t amountOf(const std::string& option, std::string_view text, bool suffix);

/// Checks the words that need no map. Throws UsageError.
void checkBudget(const BudgetInput& input);

/// --max-gaussians by scale: "N" is for every coarse scale (of a map of one scale: that), "SCALE=N" for one, and
/// stronger. Throws UsageError for scales below `first_scale`, and for fewer than a scale has cells.
std::map<int, std::size_t> maxGaussians(const BudgetInput& input, const GaussianMap<3>& map, int first_scale);
/// What the words say, for a map whose scales from `first_scale` on may be limited. MaxBytes has no size_of yet.
/// Throws UsageError.
Budget budgetOf(const BudgetInput& input, const GaussianMap<3>& map, int first_scale);
MergeCost mergeCost(const BudgetInput& input);
/// `step` with the words of the budget as they were typed, for refineStep() and simplifyStep().
std::string detailsOf(const BudgetInput& input, Json step);
/// Gives MaxBytes the size of the map file with this metadata.
void measureFile(Budget& budget, const MapMetadata& metadata, int threads);

/// The map within its budget. Adds the error curves to the metadata, and `step`, completed by the budget, to the
/// history; warns on stderr of scales that cannot reach --max-error.
GaussianMap<3> refineWithin(GaussianMap<3> map, const BudgetInput& input, MapMetadata& metadata, Json step);

}  // namespace gaussmap::app
