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

/// Limits of the number of Gaussians: the options that all commands with a budget share.
struct BudgetInput {
  double budget = PerCell().gaussians;
  std::vector<std::string> max_gaussians;  // "N" or "SCALE=N"
  std::string max_bytes;                   // with suffix k, M, G
  double max_error = 0.0;                  // [m]; 0: not given
  std::string method = "agglomerate";
  std::optional<std::string> cost;      // of a merge; only with --method agglomerate
  std::optional<std::string> distance;  // from a Gaussian to a cluster; only with --method insert
  RefineOptions refine;                 // threads, and the options of --method insert
  bool curves = true;                   // measure the error curves of other budgets
  bool as_in_paper = false;             // for the history
};
/// The words for the costs, as in --cost.
const std::map<std::string, MergeCost>& mergeCosts();
std::string wordOf(MergeCost cost);
/// Sets the options of the paper, RefineOptions::yguel2009(). The budget stays as it is.
void refineAsInPaper(BudgetInput& input);
void addBudgetOptions(Command& command, BudgetInput& input);
/// A part of these options, for commands that only merge clusters: the budgets. Returns the option --budget.
Option addLimitOptions(Command& command, BudgetInput& input);
/// A part of these options: --cost.
void addCostOption(Command& command, BudgetInput& input);
/// --smooth, for commands that merge clusters.
void addSmooth(Command& command, bool& smooth);

/// Reads a whole number > 0. If `suffix` is true, it may end in k, M or G (powers of 1000). Throws UsageError, naming
/// the option, for any other text.
std::uintmax_t amountOf(const std::string& option, std::string_view text, bool suffix);

/// Checks the options that can be checked without a map. Throws UsageError.
void checkBudget(const BudgetInput& input);
/// Returns the first option of --method insert, other than --seed, that is not at its default; empty if all are.
std::string insertOption(const BudgetInput& input);

/// Returns --max-gaussians by scale. "N" limits every coarse scale, or the only scale of a map with one scale.
/// "SCALE=N" limits one scale and has precedence. Throws UsageError for scales below `first_scale`, and if a limit is
/// smaller than the number of cells of its scale.
template <int D>
std::map<int, std::size_t> maxGaussians(const BudgetInput& input, const GaussianMap<D>& map, int first_scale);
/// Returns the budget of the options for a map. Only scales from `first_scale` on can be limited. MaxBytes::size_of is
/// not set; see measureFile(). Throws UsageError as maxGaussians() and amountOf().
template <int D>
Budget budgetOf(const BudgetInput& input, const GaussianMap<D>& map, int first_scale);
/// Returns --cost, or its default.
MergeCost mergeCost(const BudgetInput& input);
/// Returns `step` with --as-in-paper, and with --cost and --max-gaussians as the user typed them, as JSON, for
/// refineStep() and simplifyStep().
std::string detailsOf(const BudgetInput& input, Json step);
/// Sets MaxBytes::size_of to the size of the map file with this metadata. Does nothing for other budgets.
void measureFile(Budget& budget, const MapMetadata& metadata, int threads);

/// Refines the map within the budget. Adds the error curves to the metadata and `step`, completed with the budget, to
/// the history. Warns on stderr of scales that cannot reach --max-error. Throws UsageError as budgetOf().
template <int D>
GaussianMap<D> refineWithin(GaussianMap<D> map, const BudgetInput& input, MapMetadata& metadata, Json step);

}  // namespace gaussmap::app
