// SPDX-License-Identifier: BSD-3-Clause
// gaussmap refine MAP -o OUT --budget X: another number of Gaussians at the coarse scales.
#include <iostream>

#include "budget.h"
#include "common.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct RefineCommand {
  std::string map;
  Output output;
  BudgetInput budget;
  bool json = false;
};

void run(const RefineCommand& options) {
  checkMapOutput(options.output, {options.map});
  checkBudget(options.budget);
  const double start = now();
  MapMetadata metadata;
  GaussianMap<3> map = loadAnyMap(options.map, &metadata);
  if (map.isCompressed())
    throw std::runtime_error(options.map +
                             ": is compressed, its finest scale is incomplete: refine the map that it was made from");
  map = refineWithin(std::move(map), options.budget, metadata, {{"command", "refine"}, {"version", GAUSSMAP_VERSION}});
  saveMap<3>(map, options.output.path, metadata,
             {options.output.force, SaveOptions().compression, options.budget.refine.threads});
  reportMap(options.output.path, map, perScale(map), start, options.json);
}

}  // namespace

void addRefine(CLI::App& app) {
  auto options = std::make_shared<RefineCommand>();
  CLI::App* command = app.add_subcommand("refine", "Give the coarse scales of a map more (or fewer) Gaussians");
  command->footer(
      "The coarse scales are made anew from the finest: the result is that of pcd2map with the same budget and seed.\n"
      "Example: gaussmap refine street.gmap -o fine.gmap --budget 4");
  command->add_option("map", options->map, "map (.gmap, or PCD of Gaussians)")->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  addBudgetOptions(*command, options->budget);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
