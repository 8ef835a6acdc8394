// SPDX-License-Identifier: BSD-3-Clause
// gaussmap simplify MAP -o OUT: fewer Gaussians, from those that there are.
#include "gaussmap/editing/simplify.h"

#include <iostream>

#include "budget.h"
#include "common.h"
#include "gaussmap/io/gmap/map_history.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct SimplifyCommand {
  std::string map;
  Output output;
  BudgetInput limit;
  bool has_budget = false, json = false;
};

/// Completes `step` by the limit and adds it to the history.
GaussianMap<3> simplified(const GaussianMap<3>& map, const SimplifyCommand& command, MapMetadata& metadata, Json step) {
  const BudgetInput& limit = command.limit;
  const SimplifyOptions options{mergeCost(limit), limit.refine.threads};
  Budget budget = budgetOf(limit, map, 0);
  recordStep(metadata, simplifyStep(budget, options, detailsOf(limit, std::move(step))));
  measureFile(budget, metadata, options.threads);
  RefineResult<3> result = simplify<3>(map, budget, options);
  for (const NotReached& scale : result.not_reached)
    warn("scale " + std::to_string(scale.scale) + " is farther away than --max-error as it came: 95 % are within " +
         Json(scale.q95).dump() + " m; nothing of it was merged");
  return std::move(result.map);
}

void run(const SimplifyCommand& options) {
  checkMapOutput(options.output, {options.map});
  if (!options.has_budget && options.limit.max_gaussians.empty() && options.limit.max_bytes.empty() &&
      options.limit.max_error == 0.0)
    throw UsageError("simplify needs one of --budget, --max-gaussians, --max-bytes and --max-error");
  checkBudget(options.limit);
  const double start = now();
  MapMetadata metadata;
  const GaussianMap<3> old = loadAnyMap(options.map, &metadata);
  metadata.erase("error_curves");  // of the scales as they were
  const GaussianMap<3> map =
      simplified(old, options, metadata, {{"command", "simplify"}, {"version", GAUSSMAP_VERSION}});
  saveMap<3>(map, options.output.path, metadata,
             {options.output.force, SaveOptions().compression, options.limit.refine.threads});
  const std::uintmax_t bytes = std::filesystem::file_size(options.output.path);
  if (options.json) {
    printJson({{"map", options.output.path},
               {"scales", scalesOf(map)},
               {"bytes", bytes},
               {"bytes_before", std::filesystem::file_size(options.map)},
               {"seconds", now() - start}});
    return;
  }
  std::cout << options.output.path << ": Gaussians per scale " << perScale(map, old) << ", " << humanBytes(bytes)
            << '\n';
}

}  // namespace

void addSimplify(CLI::App& app) {
  auto options = std::make_shared<SimplifyCommand>();
  CLI::App* command = app.add_subcommand("simplify", "Merge the Gaussians of a map until there are as few as you want");
  command->footer(
      "Needs nothing but the Gaussians that the map has, so final and compressed maps can be simplified too; refine\n"
      "makes the coarse scales anew from the finest. Every cell keeps one Gaussian at least.\n"
      "Example: gaussmap simplify street.gmap -o small.gmap --max-gaussians 1=20000");
  command->add_option("map", options->map, "map (.gmap, or PCD of Gaussians)")->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  addLimitOptions(*command, options->limit);
  addCostOption(*command, options->limit);
  addThreads(*command, options->limit.refine.threads);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options, command] {
    options->has_budget = command->count("--budget") > 0;
    run(*options);
  });
}

}  // namespace gaussmap::app
