// SPDX-License-Identifier: BSD-3-Clause
#include "commands/budget.h"

#include <charconv>
#include <iostream>
#include <map>
#include <stdexcept>

#include "common/command.h"
#include "common/report.h"
#include "gaussmap/io/gmap/map_file.h"

namespace gaussmap::app {
namespace {

const std::map<std::string, RefineMethod> kMethods = {{"agglomerate", RefineMethod::Agglomerate},
                                                      {"insert", RefineMethod::Insert}};
const std::map<std::string, GaussianDistance> kDistances = {{"kl", GaussianDistance::KL},
                                                            {"symmetric-kl", GaussianDistance::SymmetricKL},
                                                            {"bhattacharyya", GaussianDistance::Bhattacharyya},
                                                            {"wasserstein", GaussianDistance::Wasserstein}};
const std::map<std::string, ClusterSeed> kSeedRules = {{"parent", ClusterSeed::ParentCovariance},
                                                       {"datum", ClusterSeed::InputGaussian}};

template <int D>
bool isUnrefined(const GaussianMap<D>& map) {
  for (int s = 1; s < map.scales(); ++s)
    if (map.gaussianCount(s) != map.cellCount(s)) return false;
  return true;
}

/// The options of RefineMethod::Insert. The seed is an older option, added by addBudgetOptions().
void addInsertOptions(Command& command, BudgetInput& input) {
  RefineOptions& refine = input.refine;
  const RefineOptions paper = RefineOptions::yguel2009();
  const std::string group = "With --method insert";
  command
      .number(
          "--queue", refine.queue, 0, 1000000000,
          "number of cells that get a cluster in one round; 0 = 1/250 of the cells of the scale, at least 4 (paper: " +
              std::to_string(paper.queue) + ")")
      .group(group);
  command
      .number("--max-swaps", refine.max_swaps, 0, 1000000,
              "maximum number of swaps of clusters after each insertion (Algorithm 2)")
      .group(group);
  command
      .choiceOf(
          "--seed-rule", refine.seed_rule, kSeedRules,
          R"(first covariance of a new cluster: that of the cluster around it (parent), or of the finer Gaussian there,
                as in the paper (datum))")
      .group(group);
  command
      .flag("--only-occupied", refine.only_occupied,
            "add clusters only to cells with a mean probability of occupancy above 0.5, as in the paper")
      .group(group);
  command
      .flag("--learning-factor", refine.learning_factor,
            "weight finer Gaussians by 1 - learning rate in the error of a cell, eq. (6), as in the paper")
      .group(group);
  command
      .choice("--distance", input.distance, Command::wordsOf(kDistances),
              "distance from a finer Gaussian to a cluster; default: kl, the KL divergence, as in the paper")
      .group(group);
}

}  // namespace

const std::map<std::string, MergeCost>& mergeCosts() {
  static const std::map<std::string, MergeCost> costs = {
      {"volume", MergeCost::Volume}, {"runnalls", MergeCost::Runnalls}, {"kl", MergeCost::KL}};
  return costs;
}

std::string wordOf(MergeCost cost) {
  for (const auto& [word, one] : mergeCosts())
    if (one == cost) return word;
  throw std::logic_error("a merge cost without a word");
}

void refineAsInPaper(BudgetInput& input) {
  const int threads = input.refine.threads;
  input.refine = RefineOptions::yguel2009();
  input.refine.threads = threads;
  input.method = "insert";
  input.as_in_paper = true;
}

std::uintmax_t amountOf(const std::string& option, std::string_view text, bool suffix) {
  std::uintmax_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::uintmax_t unit = 1;
  const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (suffix && rest == "k") unit = 1000;
  if (suffix && rest == "M") unit = 1000000;
  if (suffix && rest == "G") unit = 1000000000;
  if (error != std::errc() || value == 0 || (unit == 1 && !rest.empty()) || value > UINTMAX_MAX / unit)
    throw UsageError(option + " " + std::string(text) + ": expected a whole number above 0" +
                     (suffix ? ", optionally followed by k, M or G" : ""));
  return value * unit;
}

template <int D>
std::map<int, std::size_t> maxGaussians(const BudgetInput& input, const GaussianMap<D>& map, int first_scale) {
  const std::vector<std::string>& words = input.max_gaussians;
  const int scales = map.scales();
  std::map<int, std::size_t> limits;
  for (const std::string& word : words)
    if (word.find('=') == std::string::npos)
      for (int scale = std::max(first_scale, std::min(1, scales - 1)); scale < scales; ++scale)
        limits[scale] = amountOf("--max-gaussians", word, true);
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) continue;
    int scale = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + equals, scale);
    if (error != std::errc() || end != word.data() + equals || scale < first_scale || scale >= scales)
      throw UsageError("--max-gaussians " + word + ": the scales are " + std::to_string(first_scale) + " to " +
                       std::to_string(scales - 1));
    limits[scale] = amountOf("--max-gaussians", std::string_view(word).substr(equals + 1), true);
  }
  for (const auto& [scale, most] : limits)
    if (most < map.cellCount(scale))
      throw UsageError("--max-gaussians " + std::to_string(most) + ": scale " + std::to_string(scale) + " has " +
                       std::to_string(map.cellCount(scale)) +
                       " occupied cells, and each needs one Gaussian; use a larger limit or coarser cells");
  return limits;
}

template <int D>
Budget budgetOf(const BudgetInput& input, const GaussianMap<D>& map, int first_scale) {
  if (!input.max_bytes.empty()) return MaxBytes{amountOf("--max-bytes", input.max_bytes, true), {}};
  if (input.max_error > 0.0) return MaxError{input.max_error, {}};
  if (!input.max_gaussians.empty()) return MaxGaussians{maxGaussians(input, map, first_scale)};
  return PerCell{input.budget};
}

void measureFile(Budget& budget, const MapMetadata& metadata, int threads) {
  if (const auto* bytes = std::get_if<MaxBytes>(&budget))
    budget = maxFileBytes(bytes->bytes, metadata, {false, SaveOptions().compression, threads});
}

std::string detailsOf(const BudgetInput& input, Json step) {
  if (input.as_in_paper) step["as_in_paper"] = true;
  if (input.cost) step["cost"] = *input.cost;
  if (!input.max_gaussians.empty()) step["max_gaussians"] = input.max_gaussians;
  return step.dump(-1, ' ', false, Json::error_handler_t::replace);
}

MergeCost mergeCost(const BudgetInput& input) {
  return input.cost ? mergeCosts().at(*input.cost) : MergeCost::Volume;
}

Option addLimitOptions(Command& command, BudgetInput& input) {
  const Option budget = command.number("--budget", input.budget, 1.0, 1e6,
                                       "number of Gaussians per occupied cell, on average at each coarse scale");
  command.texts("--max-gaussians", input.max_gaussians,
                "maximum number of Gaussians: N for each coarse scale, or SCALE=N for one scale (>= 1); repeatable");
  command.text("--max-bytes", input.max_bytes, "maximum size of the map file [bytes], with suffix k, M or G");
  command
      .number("--max-error", input.max_error, 1e-9, 1e9,
              "maximum error [m]: at each coarse scale, 95 % of random samples lie this near to the finest scale")
      .hideDefault();
  command.exclusive({"--budget", "--max-gaussians", "--max-bytes", "--max-error"});
  return budget;
}

void addCostOption(Command& command, BudgetInput& input) {
  command
      .choice(
          "--cost", input.cost, Command::wordsOf(mergeCosts()),
          R"(which pair to merge first: the one that adds least volume (default), that loses least likelihood (runnalls),
          or that has the smallest KL divergence, as in the paper (kl))")
      .rare();
}

void addSmooth(Command& command, bool& smooth) {
  command
      .flag("--smooth", smooth,
            "after the merges, run the clustering (k-means with KL divergence) once per cell, as in the paper")
      .rare();
}

void addBudgetOptions(Command& command, BudgetInput& input) {
  addLimitOptions(command, input);
  command
      .choice("--method", input.method, Command::wordsOf(kMethods),
              R"(agglomerate: merge the Gaussians of the finer scale until the budget is met;
              insert: start with one Gaussian per cell and add clusters, as in the paper)")
      .rare();
  addCostOption(command, input);
  command.seed(input.refine.seed, "seed of the random swaps of --method insert").rare();
  addInsertOptions(command, input);
}

void checkBudget(const BudgetInput& input) {
  if (!input.max_bytes.empty()) amountOf("--max-bytes", input.max_bytes, true);
  if (input.method == "insert" && (!input.max_bytes.empty() || input.max_error > 0.0))
    throw UsageError("--method insert: supports only --budget and --max-gaussians");
  if (input.method == "insert" && input.cost) throw UsageError("--cost: only for --method agglomerate");
  const std::string option = insertOption(input);
  if (input.method != "insert" && !option.empty())
    throw UsageError(option + ": only for --method insert; add this option");
}

std::string insertOption(const BudgetInput& input) {
  const RefineOptions usual, &given = input.refine;
  if (given.queue != usual.queue) return "--queue";
  if (given.max_swaps != usual.max_swaps) return "--max-swaps";
  if (given.seed_rule != usual.seed_rule) return "--seed-rule";
  if (given.only_occupied) return "--only-occupied";
  if (given.learning_factor) return "--learning-factor";
  return input.distance ? "--distance" : "";
}

template <int D>
GaussianMap<D> refineWithin(GaussianMap<D> map, const BudgetInput& input, MapMetadata& metadata, Json step) {
  Budget budget = budgetOf(input, map, 1);
  RefineOptions options = input.refine;
  options.method = kMethods.at(input.method);
  options.merge_cost = mergeCost(input);
  if (input.distance) options.distance = kDistances.at(*input.distance);
  const auto* per_cell = std::get_if<PerCell>(&budget);
  const bool one_per_cell = per_cell != nullptr && per_cell->gaussians == 1.0;
  const bool is_searched = !input.max_bytes.empty() || input.max_error > 0.0;
  if (is_searched || (input.curves && !one_per_cell && options.method == RefineMethod::Agglomerate))
    options.curves.emplace();
  recordStep(metadata, refineStep(budget, options, detailsOf(input, std::move(step))));
  recordCurves(metadata, {});  // the old curves describe the old map
  if (one_per_cell && isUnrefined(map)) return map;
  measureFile(budget, metadata, options.threads);
  RefineResult<D> result = refine<D>(std::move(map), budget, options);
  for (const NotReached& scale : result.not_reached)
    std::cerr << "gaussmap: warning: scale " << scale.scale << " does not reach --max-error " << input.max_error
              << ": with as many Gaussians as the finer scale, 95 % of the samples lie within " << scale.q95 << " m\n";
  recordCurves(metadata, result.curves);
  return std::move(result.map);
}

#define GAUSSMAP_INSTANTIATE(D)                                                                     \
  template std::map<int, std::size_t> maxGaussians(const BudgetInput&, const GaussianMap<D>&, int); \
  template Budget budgetOf(const BudgetInput&, const GaussianMap<D>&, int);                         \
  template GaussianMap<D> refineWithin(GaussianMap<D>, const BudgetInput&, MapMetadata&, Json);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap::app
