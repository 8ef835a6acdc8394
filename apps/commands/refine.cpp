// SPDX-License-Identifier: BSD-3-Clause
// gaussmap refine MAP -o OUT --budget X: changes the number of Gaussians at the coarse scales.
#include <memory>
#include <stdexcept>

#include "commands/budget.h"
#include "commands/commands.h"
#include "commands/map_task.h"
#include "common/command.h"

namespace gaussmap::app {
namespace {

struct RefineCommand : MapTaskOptions {
  BudgetInput budget;
};

const Help kRefineHelp = {
    "Change the number of Gaussians at the coarse scales of a map",
    "gaussmap refine street.gmap -o fine.gmap --budget 4",
    R"(The coarse scales are rebuilt from the finest scale. The result equals that of pcd2map with the same budget and
seed. A compressed map cannot be refined, because its finest scale is incomplete.

--as-in-paper: --method insert --queue 4 --seed-rule datum --only-occupied --learning-factor, as in Yguel et al. 2009.
4 cells get a cluster in one round, a new cluster starts as a copy of a finer Gaussian, and free cells get no more
clusters. Options that are also given override these settings. The paper prints no budget, so --budget keeps its
default.)"};

template <int D>
void run(RefineCommand command) {
  MapTask task(command);
  checkBudget(command.budget);
  GaussianMap<D> map = task.load<D>();
  if (map.isCompressed())
    throw std::runtime_error(command.map + ": is compressed, so its finest scale is incomplete; use the original map");
  command.budget.refine.threads = command.threads;
  map = refineWithin(std::move(map), command.budget, task.metadata, historyStep("refine"));
  task.save(map);
  task.report(map);
}

}  // namespace

void addRefine(CLI::App& app) {
  auto options = std::make_shared<RefineCommand>();
  Command command(app, "refine", kRefineHelp);
  addMapToMap(command, *options);
  command.preset(
      "--as-in-paper", [options] { refineAsInPaper(options->budget); }, "use the settings of Yguel et al. 2009");
  addBudgetOptions(command, options->budget);
  addRunOptions(command, *options);
  command.onRun([options] { forMap(options->map, [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
