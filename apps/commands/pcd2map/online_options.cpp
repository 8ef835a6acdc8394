// SPDX-License-Identifier: BSD-3-Clause
#include "commands/pcd2map/online_options.h"

#include <map>

#include "common/options.h"

namespace gaussmap::app {
namespace {

const std::map<std::string, LearningRate> kRates = {{"sample-mean", LearningRate::SampleMean},
                                                    {"occupancy", LearningRate::Occupancy}};
const std::map<std::string, OccupancySamples> kSamples = {{"mean", OccupancySamples::Mean},
                                                          {"random", OccupancySamples::Random}};

}  // namespace

void addOnlineOptions(CLI::App& command, OnlineInput& input) {
  CLI::Option* const online =
      command.add_flag("--online", input.on, "map scan by scan: occupancy from range images, deletes what has moved");
  const auto option = [&](CLI::Option* made) { return made->needs(online)->group("With --online"); };
  OnlineOptions& options = input.options;
  option(command.add_option("--learning-rate", options.learning_rate, "how far a point moves its cluster"))
      ->transform(CLI::CheckedTransformer(kRates, CLI::ignore_case))
      ->default_str("sample-mean");
  option(command.add_option("--occupancy-every", options.occupancy_every, "scans between two updates of the occupancy"))
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  option(command.add_option("--occupancy-samples", options.samples,
                            "which points of a cluster are tested: its mean, or random samples"))
      ->transform(CLI::CheckedTransformer(kSamples, CLI::ignore_case))
      ->default_str("mean");
  option(command.add_option("--look-back", options.look_back, "earlier range images that new cells are tested with"))
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
  option(command.add_option("--no-return-is-free", input.no_return_is_free,
                            "count directions without a return as free space up to this range [m]"))
      ->check(numberBetween(1e-3, 1e6));
  option(command.add_option("--max-ranges", options.max_ranges,
                            "one per scale, finest first: cells farther away are not tested [m]"))
      ->delimiter(',')
      ->check(numberBetween(1e-3, 1e9));
  option(command.add_flag("--keep", input.keep, "delete nothing"));
  option(command.add_option("--refine-every", options.refine_every, "scans between two refinements, 0 = never"))
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  option(command.add_option("--refine-cells", options.refine_cells,
                            "most clusters that one refinement adds to a scale, 0 = as many as the budget allows "
                            "(in the paper: 4)"))
      ->check(CLI::Range(0, 1000000000))
      ->capture_default_str();
  option(command.add_option("--stats", input.stats, "write what each scan changed and how long it took (.csv)"));
  option(command.add_option("--removed", input.removed, "write the deleted clusters, with the evidence (.pcd)"));
}

void checkOnline(const OnlineInput& input, const BudgetInput& budget, const Output& map,
                 const std::vector<std::filesystem::path>& inputs) {
  if (!input.on) return;
  if (!budget.max_gaussians.empty() || !budget.max_bytes.empty() || budget.max_error > 0.0)
    throw UsageError("--online takes --budget only: refine the map afterwards for another limit");
  if (budget.cost || budget.cells) throw UsageError("--online takes neither --cost nor --cells");
  if (budget.refine.seed != RefineOptions().seed) throw UsageError("--online takes no --seed");
  checkOutputs({input.stats, input.removed}, map.force, inputs, {map.path});
}

OnlineOptions onlineOptions(const OnlineInput& input, const MapOptions& map, const BudgetInput& budget) {
  OnlineOptions options = input.options;
  options.map = map;
  options.threads = budget.refine.threads;
  options.budget = budget.budget;
  options.method = budget.method == "insert" ? RefineMethod::Insert : RefineMethod::Agglomerate;
  options.forget = !input.keep;
  if (input.no_return_is_free > 0.0) options.no_return_is_free = input.no_return_is_free;
  return options;
}

}  // namespace gaussmap::app
