// SPDX-License-Identifier: BSD-3-Clause
// gaussmap simplify MAP -o OUT: merges existing Gaussians, so that fewer are left.
#include "gaussmap/editing/simplify.h"

#include <memory>

#include "commands/budget.h"
#include "commands/commands.h"
#include "commands/map_task.h"
#include "common/command.h"
#include "common/report.h"
#include "gaussmap/io/gmap/map_file.h"

namespace gaussmap::app {
namespace {

struct SimplifyCommand : MapTaskOptions {
  BudgetInput limit;
  bool has_budget = false;
  bool smooth = false;
};

/// Sets the options of the paper. The limit stays as it is.
void simplifyAsInPaper(SimplifyCommand& command) {
  const SimplifyOptions paper = SimplifyOptions::yguel2009();
  command.limit.cost = wordOf(paper.merge_cost);
  command.limit.as_in_paper = true;
  command.smooth = paper.smooth;
}

const Help kSimplifyHelp = {
    "Merge Gaussians of a map until it is small enough",
    "gaussmap simplify street.gmap -o small.gmap --max-gaussians 1=20000",
    R"(Needs one of --budget, --max-gaussians, --max-bytes and --max-error. Merges the Gaussians that the map has, so it
also works on final and compressed maps. To rebuild the coarse scales from the finest scale, use gaussmap refine.
Every cell keeps at least one Gaussian.

--as-in-paper: --cost kl --smooth, as in Yguel et al. 2009. Options that are also given override these settings.)"};

/// Simplifies the map within the limit. Adds `step`, completed with the limit, to the history.
template <int D>
GaussianMap<D> simplified(const GaussianMap<D>& map, const SimplifyCommand& command, MapMetadata& metadata, Json step) {
  const BudgetInput& limit = command.limit;
  SimplifyOptions options{mergeCost(limit), command.threads};
  options.smooth = command.smooth;
  Budget budget = budgetOf(limit, map, 0);
  recordStep(metadata, simplifyStep(budget, options, detailsOf(limit, std::move(step))));
  measureFile(budget, metadata, options.threads);
  RefineResult<D> result = simplify<D>(map, budget, options);
  for (const NotReached& scale : result.not_reached)
    warn("scale " + std::to_string(scale.scale) +
         " exceeds --max-error before merging: 95 % of its samples lie within " + Json(scale.q95).dump() +
         " m; it stays unchanged");
  return std::move(result.map);
}

template <int D>
void run(const SimplifyCommand& command) {
  MapTask task(command);
  const BudgetInput& limit = command.limit;
  if (!command.has_budget && limit.max_gaussians.empty() && limit.max_bytes.empty() && limit.max_error == 0.0)
    throw UsageError("simplify needs one of --budget, --max-gaussians, --max-bytes and --max-error");
  checkBudget(limit);
  const GaussianMap<D> old = task.load<D>();
  task.metadata.erase("error_curves");  // they describe the old map
  const GaussianMap<D> map = simplified(old, command, task.metadata, historyStep("simplify"));
  task.save(map);
  task.report(map, old, {{"bytes_before", task.bytesBefore()}});
}

}  // namespace

void addSimplify(CLI::App& app) {
  auto options = std::make_shared<SimplifyCommand>();
  Command command(app, "simplify", kSimplifyHelp);
  addMapToMap(command, *options);
  command.preset(
      "--as-in-paper", [options] { simplifyAsInPaper(*options); }, "use the settings of Yguel et al. 2009");
  addLimitOptions(command, options->limit).hideDefault();
  addCostOption(command, options->limit);
  addSmooth(command, options->smooth);
  addRunOptions(command, *options);
  command.onRun([options, command] {
    options->has_budget = command.isGiven("--budget");
    forMap(options->map, [&](auto dimensions) { run<dimensions()>(*options); });
  });
}

}  // namespace gaussmap::app
