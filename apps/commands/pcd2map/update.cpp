// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <optional>

#include "commands/pcd2map/pcd2map.h"
#include "commands/pcd2map/scan_report.h"
#include "common/progress_bar.h"
#include "common/report.h"
#include "gaussmap/io/gmap/map_update.h"

namespace gaussmap::app {
namespace {

/// Budget and cost of the last refinement in the history of a map.
struct Recorded {
  std::optional<double> budget;
  std::optional<std::string> cost;
};

Recorded recordedIn(const MapMetadata& metadata) {
  Recorded recorded;
  const Json history = jsonEntry(metadata, "history");
  if (!history.is_array()) return recorded;
  for (const Json& step : history) {
    if (!step.is_object() || !step.contains("method")) continue;
    recorded = {};
    if (step.contains("budget") && step["budget"].is_number() && step["budget"] >= 1.0)
      recorded.budget = step["budget"].get<double>();
    if (step.contains("cost") && step["cost"].is_string()) recorded.cost = step["cost"].get<std::string>();
  }
  return recorded;
}

AccumulatedScans accumulate(const Pcd2mapOptions& options, const Scans& scans, double resolution) {
  ProgressBar bar;
  AccumulatedScans accumulated =
      accumulateScans(scans, accumulateOptions(options.input, resolution, options.budget.refine.threads),
                      [&](const AccumulateProgress& progress) { bar.show(progress); });
  requirePoints(accumulated.counts, scans);
  return accumulated;
}

void report(const Pcd2mapOptions& options, const Scans& scans, const PointCounts& counts, const MapUpdate& update,
            double start) {
  const std::uintmax_t bytes = std::filesystem::file_size(options.update);
  const double seconds = now() - start;
  if (options.json) {
    Json scales = Json::array();
    for (std::size_t s = 0; s < update.cells.size(); ++s)
      scales.push_back({{"scale", s}, {"cells", update.cells[s]}, {"gaussians", update.gaussians[s]}});
    return printJson({{"map", options.update},
                      {"scans", scans.size()},
                      {"points", countsJson(counts)},
                      {"scales", scales},
                      {"tiles", update.tiles},
                      {"tiles_written", update.tiles_written},
                      {"bytes", bytes},
                      {"seconds", seconds}});
  }
  std::cout << options.update << ": " << summaryOf(scans, counts) << " added, Gaussians per scale "
            << perScale(update.gaussians) << ", " << update.tiles_written << " of " << update.tiles
            << " tiles written, " << humanBytes(bytes) << ", " << secondsText(seconds) << " s\n";
}

}  // namespace

void updateFromScans(const Pcd2mapOptions& options) {
  const double start = now();
  const MapOptions map = growingMapOptions<3>(options.update);
  const Recorded recorded = recordedIn(loadMetadata(options.update));
  const PcdScans scans = openScans(options.input);
  const AccumulatedScans accumulated = accumulate(options, scans, map.resolution);

  BudgetInput merging = options.budget;
  if (!merging.cost) merging.cost = recorded.cost;
  UpdateOptions updating;
  updating.budget = options.update_budget ? options.update_budget : recorded.budget;
  updating.merge_cost = mergeCost(merging);
  updating.threads = options.budget.refine.threads;
  Json step = historyOf(scans, accumulated.counts);
  step["update"] = true;
  step["method"] = "agglomerate";
  if (updating.budget) step["budget"] = *updating.budget;
  if (merging.cost) step["cost"] = *merging.cost;
  const MapUpdate update = updateMap<3>(options.update, accumulated.moments, updating, [&](MapMetadata& metadata) {
    metadata.erase("error_curves");  // they describe the old map
    addHistory(metadata, step);
  });
  report(options, scans, accumulated.counts, update, start);
}

}  // namespace gaussmap::app
