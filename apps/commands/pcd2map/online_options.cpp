// SPDX-License-Identifier: BSD-3-Clause
#include "commands/pcd2map/online_options.h"

#include <cmath>
#include <map>

#include "commands/depth_noise.h"
#include "commands/evidence_options.h"
#include "common/command.h"
#include "core/number_text.h"

namespace gaussmap::app {
namespace {

const std::map<std::string, LearningRate> kRates = {{"sample-mean", LearningRate::SampleMean},
                                                    {"occupancy", LearningRate::Occupancy}};
const std::map<std::string, OccupancySamples> kSamples = {{"mean", OccupancySamples::Mean},
                                                          {"random", OccupancySamples::Random}};

}  // namespace

void addOnlineOptions(Command& command, OnlineInput& input, const Option& as_in_paper) {
  constexpr double kMaxLogOdds = kMaxOccupancy;
  OnlineOptions& options = input.options;
  const Option online = command.flag("--online", input.on,
                                     "add scans one by one: learn occupancy from range images, delete what has moved");
  for (const Option& option : {
           command.choiceOf("--learning-rate", options.learning_rate, kRates,
                            "weight of a new point: sample-mean = 1/n, occupancy = Yguel 2009, eq. (5)"),
           command.number("--occupancy-every", options.occupancy_every, 1, 1000000,
                          "number of scans between two updates of the occupancy"),
           command.choiceOf("--occupancy-samples", options.samples, kSamples,
                            "points of a cluster that are tested: its mean, or random samples"),
           command.number("--look-back", options.look_back, 0, 100000,
                          "number of earlier range images that new cells are tested against"),
           command.number("--no-return-is-free", options.no_return_is_free, 1e-3, 1e6,
                          "treat directions without a return as free space up to this range [m]"),
           addDepthNoise(command, input.depth_noise),
           command.list("--max-ranges", options.max_ranges, 1e-3, 1e9,
                        "do not test cells farther than this [m]: one range per scale, finest first"),
           command.flag("--keep", input.keep, "do not delete clusters"),
           command.number("--refine-every", options.refine_every, 0, 1000000,
                          "number of scans between two refinements, 0 = never"),
           command.number("--refine-cells", options.refine_cells, 0, 1000000000,
                          "maximum clusters that a refinement adds to a scale, 0 = no limit (paper: 4)"),
           command.text("--stats", input.stats, "CSV file to write: what each scan changed, and how long it took"),
           command.text("--removed", input.removed, "PCD file to write: the deleted clusters and their evidence"),
       })
    option.needs(online).group("With --online");
  as_in_paper.needs(online).group("With --online");
  std::vector<Option> constants = {
      command.number("--slowest-rate", options.slowest_rate, 1e-9, 1.0,
                     "--learning-rate occupancy: weight of a new point where the map is certain, eps_min of eq. (5)"),
      command.number("--fastest-rate", options.fastest_rate, 1e-9, 1.0,
                     "--learning-rate occupancy: weight of a new point where the map is uncertain, eps_max of eq. (5)"),
      command.number("--max-log-odds", options.occupancy.max_log_odds, 0.1, kMaxLogOdds,
                     "limit of the log-odds of a cluster, o_max of eq. (5)"),
      command.number("--forget-below", options.forget_below, -kMaxLogOdds, kMaxLogOdds,
                     "clusters whose log-odds fall below this value are deleted"),
      command.number("--max-samples", options.max_samples, 0, 1000000000,
                     "--occupancy-samples random: maximum samples per cluster, 0 = as many as eq. (1) gives"),
  };
  const std::vector<Option> evidence =
      addEvidenceOptions(command, {options.occupancy, options.visibility, options.link, options.reach});
  constants.insert(constants.end(), evidence.begin(), evidence.end());
  for (const Option& option : constants) option.needs(online).group("With --online: constants");
  command.files({"--stats"}, {".csv"});
  command.files({"--removed"}, {".pcd"});
}

void checkOnline(const OnlineInput& input, const BudgetInput& budget, double resolution, const Output& map,
                 const std::vector<std::filesystem::path>& inputs) {
  if (!input.on) return;
  const OnlineOptions& options = input.options;
  if (options.slowest_rate > options.fastest_rate)
    throw UsageError("--slowest-rate: must not exceed --fastest-rate, which is " +
                     detail::numberText(options.fastest_rate));
  if (std::abs(options.forget_below) > options.occupancy.max_log_odds)
    throw UsageError("--forget-below: must lie between -M and M, with M = --max-log-odds = " +
                     detail::numberText(options.occupancy.max_log_odds));
  checkLink(options.link, resolution);
  if (!budget.max_gaussians.empty() || !budget.max_bytes.empty() || budget.max_error > 0.0)
    throw UsageError("--online: supports only --budget; use gaussmap refine afterwards for another limit");
  if (budget.cost) throw UsageError("--cost: not with --online");
  if (budget.refine.seed != RefineOptions().seed) throw UsageError("--seed: not with --online");
  BudgetInput others = budget;
  others.refine.seed_rule = RefineOptions().seed_rule;  // the only one of these options that a refinement on line has
  if (const std::string option = insertOption(others); !option.empty())
    throw UsageError(option + ": not with --online; refine the map afterwards with gaussmap refine");
  checkOutputs({input.stats, input.removed}, map.force, inputs, {map.path});
  refuseOtherKinds(input.stats, "a table", {".csv", ".txt"});
  refuseOtherKinds(input.removed, "a PCD file", {".pcd"});
}

OnlineOptions onlineOptions(const OnlineInput& input, const MapOptions& map, const AccumulateOptions& reading,
                            const BudgetInput& budget) {
  OnlineOptions options = input.options;
  options.map = map;
  options.max_range = reading.max_range;
  options.min_range = reading.min_range;
  options.crop = reading.crop;
  options.visibility.noise = depthNoise(input.depth_noise);
  options.threads = budget.refine.threads;
  options.budget = budget.budget;
  options.method = budget.method == "insert" ? RefineMethod::Insert : RefineMethod::Agglomerate;
  options.seed_rule = budget.refine.seed_rule;
  options.forget = !input.keep;
  return options;
}

}  // namespace gaussmap::app
