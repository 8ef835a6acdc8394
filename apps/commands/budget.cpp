// SPDX-License-Identifier: BSD-3-Clause
#include "commands/budget.h"

#include <charconv>
#include <iostream>
#include <map>

#include "common/command.h"
#include "common/report.h"

namespace gaussmap::app {
namespace {

const std::map<std::string, RefineMethod> kMethods = {{"agglomerate", RefineMethod::Agglomerate},
                                                      {"insert", RefineMethod::Insert}};
const std::map<std::string, MergeCost> kCosts = {
    {"volume", MergeCost::Volume}, {"runnalls", MergeCost::Runnalls}, {"volume-area", MergeCost::VolumeArea}};
const std::map<std::string, CellChoice> kCellChoices = {{"error", CellChoice::Error}, {"volume", CellChoice::Volume}};

Json jsonOf(const std::vector<ErrorCurve>& curves) {
  Json all = Json::array();
  for (const ErrorCurve& curve : curves) {
    Json points = Json::array();
    for (const ErrorPoint& point : curve.points)
      points.push_back({{"gaussians", point.gaussians}, {"q99", point.q99}, {"q95", point.q95}, {"mean", point.mean}});
    all.push_back({{"scale", curve.scale}, {"points", points}});
  }
  return all;
}

bool isUnrefined(const GaussianMap<3>& map) {
  for (int s = 1; s < map.scales(); ++s)
    if (map.gaussianCount(s) != map.cellCount(s)) return false;
  return true;
}

}  // namespace

std::uintmax_t amountOf(const std::string& option, std::string_view text, bool suffix) {
  std::uintmax_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  std::uintmax_t unit = 1;
  const std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  if (suffix && rest == "k") unit = 1000;
  if (suffix && rest == "M") unit = 1000000;
  if (suffix && rest == "G") unit = 1000000000;
  if (error != std::errc() || value == 0 || (unit == 1 && !rest.empty()) || value > UINTMAX_MAX / unit)
    throw UsageError(option + " " + std::string(text) + ": is no whole number above 0" +
                     (suffix ? ", with k, M or G behind it if you like" : ""));
  return value * unit;
}

std::map<int, std::size_t> maxGaussians(const BudgetInput& input, const GaussianMap<3>& map, int first_scale) {
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
                       " occupied cells, which hold at least one each; take more, or coarser cells");
  return limits;
}

std::uintmax_t maxBytes(const BudgetInput& input) {
  return amountOf("--max-bytes", input.max_bytes, true);
}

MergeCost mergeCost(const BudgetInput& input) {
  return input.cost ? kCosts.at(*input.cost) : MergeCost::Volume;
}

Option addLimitOptions(Command& command, BudgetInput& input) {
  const Option budget =
      command.number("--budget", input.budget, 1.0, 1e6, "Gaussians per occupied cell of a coarse scale, on average");
  command.texts("--max-gaussians", input.max_gaussians,
                "most Gaussians of each coarse scale: N, or SCALE=N for one (repeatable)");
  command.text("--max-bytes", input.max_bytes, "most bytes of the whole file, with suffix k, M or G");
  command
      .number("--max-error", input.max_error, 1e-9, 1e9,
              "fewest Gaussians so that 95 % of the samples of a coarse scale lie within this distance of the finest "
              "scale [m]")
      .hideDefault();
  command.exclusive({"--budget", "--max-gaussians", "--max-bytes", "--max-error"});
  return budget;
}

void addCostOption(Command& command, BudgetInput& input) {
  command
      .choice(
          "--cost", input.cost, Command::wordsOf(kCosts),
          "cost of a merge (agglomerate): volume (default), the growth of the ellipsoids' volume; runnalls, the loss "
          "of likelihood; volume-area, which keeps large surfaces longer")
      .rare();
}

void addBudgetOptions(Command& command, BudgetInput& input) {
  addLimitOptions(command, input);
  command
      .choice("--method", input.method, Command::wordsOf(kMethods),
              "agglomerate: merge the Gaussians of the finer scale until the budget is met; insert: split one cluster "
              "after the other, as in the paper")
      .rare();
  addCostOption(command, input);
  command
      .choice("--cells", input.cells, Command::wordsOf(kCellChoices),
              "which cell --method insert gives the next cluster to: that of the largest error (default, as in the "
              "paper), or of the largest volume of ellipsoids")
      .rare();
  command.seed(input.refine.seed, "seed of the random swaps of --method insert").rare();
}

void checkBudget(const BudgetInput& input) {
  if (!input.max_bytes.empty()) maxBytes(input);
  if (input.method == "insert" && (!input.max_bytes.empty() || input.max_error > 0.0))
    throw UsageError("--method insert: knows --budget and --max-gaussians only");
  if (input.method == "insert" && input.cost) throw UsageError("--cost: for --method agglomerate only");
  if (input.method != "insert" && input.cells) throw UsageError("--cells: for --method insert only");
}

GaussianMap<3> refineWithin(GaussianMap<3> map, const BudgetInput& input, MapMetadata& metadata, Json step) {
  RefineOptions options = input.refine;
  options.budget = input.budget;
  options.method = kMethods.at(input.method);
  options.merge_cost = mergeCost(input);
  if (input.cells) options.cell_choice = kCellChoices.at(*input.cells);
  options.max_gaussians = maxGaussians(input, map, 1);
  step["method"] = input.method;
  if (input.cost) step["cost"] = *input.cost;
  if (input.cells) step["cells"] = *input.cells;
  const auto keepCurves = [](MapMetadata& into, const std::vector<ErrorCurve>& curves) {
    into["error_curves"] = jsonOf(curves).dump();
  };
  metadata.erase("error_curves");  // of the map as it was

  if (!input.max_bytes.empty()) {
    const std::uintmax_t most = maxBytes(input);
    step["max_bytes"] = most;
    addHistory(metadata, step);
    const SaveOptions saving{false, SaveOptions().compression, options.threads};
    RefinedMap refined = refineToBytes(
        map, most,
        [&](const RefinedMap& tried) {
          MapMetadata with = metadata;
          keepCurves(with, tried.curves);
          return savedSize<3>(tried.map, with, saving);
        },
        options);
    keepCurves(metadata, refined.curves);
    return std::move(refined.map);
  }
  if (input.max_error > 0.0) {
    step["max_error"] = input.max_error;
    addHistory(metadata, step);
    RefinedToError to_error = refineToError(std::move(map), input.max_error, options);
    for (const ErrorNotReached& scale : to_error.not_reached)
      std::cerr << "gaussmap: warning: scale " << scale.scale << " does not reach --max-error " << input.max_error
                << ": with all that the finer scale's Gaussians allow 95 % are within " << scale.q95 << " m\n";
    keepCurves(metadata, to_error.refined.curves);
    return std::move(to_error.refined.map);
  }
  if (options.max_gaussians.empty())
    step["budget"] = options.budget;
  else
    step["max_gaussians"] = input.max_gaussians;
  if (options.method == RefineMethod::Insert) step["seed"] = options.seed;
  addHistory(metadata, step);
  const bool one_per_cell = options.max_gaussians.empty() && options.budget == 1.0;
  if (one_per_cell && isUnrefined(map)) return map;
  if (one_per_cell || !input.curves || options.method == RefineMethod::Insert)
    return refine<3>(std::move(map), options);
  RefinedMap refined = refineWithCurves(std::move(map), options);
  keepCurves(metadata, refined.curves);
  return std::move(refined.map);
}

}  // namespace gaussmap::app
