// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/gmap/map_file.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <variant>

namespace gaussmap {
namespace {

using HistoryJson = nlohmann::ordered_json;

/// Returns JSON as text. File names may not be valid UTF-8, but JSON must be, so invalid bytes are replaced.
std::string textOf(const HistoryJson& json) {
  return json.dump(-1, ' ', false, HistoryJson::error_handler_t::replace);
}

HistoryJson parseObject(const std::string& text) {
  HistoryJson json = HistoryJson::parse(text, nullptr, false);
  if (!json.is_object()) throw std::invalid_argument("a step of the history must be a JSON object, not: " + text);
  return json;
}

/// Writes the budget into a step.
struct BudgetWriter {
  HistoryJson& step;

  void operator()(const PerCell& budget) const { step["budget"] = budget.gaussians; }
  void operator()(const MaxGaussians& budget) const {
    HistoryJson limits = HistoryJson::array();
    for (const auto& [scale, most] : budget.by_scale)
      limits.push_back(std::to_string(scale) + "=" + std::to_string(most));
    step["max_gaussians"] = limits;
  }
  void operator()(const MaxBytes& budget) const { step["max_bytes"] = budget.bytes; }
  void operator()(const MaxError& budget) const { step["max_error"] = budget.metres; }
};

/// Joins two objects: first the members that only `details` has, then the members of `own`. A member that both have
/// takes its value from `details`. Members of `own` that are null are left out.
std::string withDetails(const HistoryJson& own, const std::string& details) {
  const HistoryJson given = parseObject(details);
  HistoryJson step = HistoryJson::object();
  for (const auto& [name, value] : given.items())
    if (!own.contains(name)) step[name] = value;
  for (const auto& [name, value] : own.items()) {
    if (given.contains(name))
      step[name] = given[name];
    else if (!value.is_null())
      step[name] = value;
  }
  return textOf(step);
}

HistoryJson wordOf(MergeCost cost) {
  if (cost == MergeCost::KL) return "kl";
  return cost == MergeCost::Runnalls ? HistoryJson("runnalls") : HistoryJson();
}

const char* wordOf(GaussianDistance distance) {
  switch (distance) {
    case GaussianDistance::SymmetricKL:
      return "symmetric-kl";
    case GaussianDistance::Bhattacharyya:
      return "bhattacharyya";
    case GaussianDistance::Wasserstein:
      return "wasserstein";
    case GaussianDistance::KL:
      break;
  }
  return "kl";
}

}  // namespace

std::string refineStep(const Budget& budget, const RefineOptions& options, const std::string& details) {
  const bool inserts = options.method == RefineMethod::Insert;
  HistoryJson own = {{"method", inserts ? "insert" : "agglomerate"}, {"cost", wordOf(options.merge_cost)}};
  std::visit(BudgetWriter{own}, budget);
  if (inserts) {
    const RefineOptions usual;
    own["seed"] = options.seed;
    if (options.queue != usual.queue) own["queue"] = options.queue;
    if (options.max_swaps != usual.max_swaps) own["max_swaps"] = options.max_swaps;
    if (options.seed_rule == ClusterSeed::InputGaussian) own["seed_rule"] = "datum";
    if (options.only_occupied) own["only_occupied"] = true;
    if (options.learning_factor) own["learning_factor"] = true;
    if (options.distance != usual.distance) own["distance"] = wordOf(options.distance);
  }
  return withDetails(own, details);
}

std::string simplifyStep(const Budget& budget, const SimplifyOptions& options, const std::string& details) {
  HistoryJson own = {{"cost", wordOf(options.merge_cost)}};
  std::visit(BudgetWriter{own}, budget);
  if (options.smooth) own["smooth"] = true;
  return withDetails(own, details);
}

void recordStep(MapMetadata& metadata, const std::string& step) {
  HistoryJson history = HistoryJson::array();
  const auto entry = metadata.find(kHistoryEntry);
  if (entry != metadata.end()) {
    HistoryJson old = HistoryJson::parse(entry->second, nullptr, false);
    if (old.is_array()) history = std::move(old);
  }
  history.push_back(parseObject(step));
  metadata[kHistoryEntry] = textOf(history);
}

void recordCurves(MapMetadata& metadata, const std::vector<ErrorCurve>& curves) {
  metadata.erase(kCurvesEntry);
  if (curves.empty()) return;
  HistoryJson all = HistoryJson::array();
  for (const ErrorCurve& curve : curves) {
    HistoryJson points = HistoryJson::array();
    for (const ErrorPoint& point : curve.points)
      points.push_back({{"gaussians", point.gaussians}, {"q99", point.q99}, {"q95", point.q95}, {"mean", point.mean}});
    all.push_back({{"scale", curve.scale}, {"points", points}});
  }
  metadata[kCurvesEntry] = all.dump();
}

template <int D>
void save(const std::filesystem::path& path, const RefineResult<D>& result, MapMetadata metadata,
          const SaveOptions& options) {
  recordCurves(metadata, result.curves);
  save<D>(path, result.map, metadata, options);
}

template <int D>
std::uintmax_t savedSize(const RefineResult<D>& result, MapMetadata metadata, const SaveOptions& options) {
  recordCurves(metadata, result.curves);
  return savedSize<D>(result.map, metadata, options);
}

MaxBytes maxFileBytes(std::uintmax_t bytes, const MapMetadata& metadata, const SaveOptions& options) {
  return {bytes, [metadata, options](const RefineResult<3>& result) { return savedSize<3>(result, metadata, options); },
          [metadata, options](const RefineResult<2>& result) { return savedSize<2>(result, metadata, options); }};
}

#define GAUSSMAP_INSTANTIATE(D)                                                                                 \
  template void save<D>(const std::filesystem::path&, const RefineResult<D>&, MapMetadata, const SaveOptions&); \
  template std::uintmax_t savedSize<D>(const RefineResult<D>&, MapMetadata, const SaveOptions&);
GAUSSMAP_INSTANTIATE(2)
GAUSSMAP_INSTANTIATE(3)
#undef GAUSSMAP_INSTANTIATE

}  // namespace gaussmap
