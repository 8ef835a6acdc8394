// SPDX-License-Identifier: BSD-3-Clause
// gaussmap pcd2map --update MAP IN...: adds scans to a map where they fall.
#include "update.h"

#include <cmath>
#include <iostream>

#include "gaussmap/io/gmap/map_update.h"
#include "gaussmap/mapping/accumulate_scans.h"
#include "scan_report.h"

namespace gaussmap::app {
using namespace detail;

namespace {

/// What the last step that refined the map was asked for.
struct Recorded {
  std::optional<double> budget;
  std::optional<std::string> cost;
};

Recorded recordedIn(const MapMetadata& metadata) {
  Recorded recorded;
  const auto entry = metadata.find("history");
  const Json history = entry == metadata.end() ? Json() : Json::parse(entry->second, nullptr, false);
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

}  // namespace

void updateFromScans(const UpdateInput& input, const ScanInput& scan_input, const BudgetInput& budget, bool json) {
  const double start = now();
  const MapOptions map = growingMapOptions<3>(input.map);
  const Recorded recorded = recordedIn(loadMetadata(input.map));
  const PcdScans scans = openScans(scan_input);
  AccumulatedScans accumulated{MomentGrid<3>(map.resolution), {}};
  {
    ProgressBar bar;
    accumulated = accumulateScans(scans, accumulateOptions(scan_input, map.resolution, budget.refine.threads),
                                  [&](const AccumulateProgress& progress) { bar.show(progress); });
  }
  requirePoints(accumulated.counts, scans);

  BudgetInput merging = budget;
  if (!merging.cost) merging.cost = recorded.cost;
  UpdateOptions options;
  options.budget = input.budget ? input.budget : recorded.budget;
  options.merge_cost = mergeCost(merging);
  options.threads = budget.refine.threads;
  Json step = historyOf(scans, accumulated.counts);
  step["update"] = true;
  step["method"] = "agglomerate";
  if (options.budget) step["budget"] = *options.budget;
  if (merging.cost) step["cost"] = *merging.cost;
  const MapUpdate update = updateMap<3>(input.map, accumulated.moments, options, [&](MapMetadata& metadata) {
    metadata.erase("error_curves");  // of the map as it was
    addHistory(metadata, step);
  });

  const std::uintmax_t bytes = std::filesystem::file_size(input.map);
  const double seconds = now() - start;
  if (json) {
    Json scales = Json::array();
    for (std::size_t s = 0; s < update.cells.size(); ++s)
      scales.push_back({{"scale", s}, {"cells", update.cells[s]}, {"gaussians", update.gaussians[s]}});
    printJson({{"map", input.map},
               {"scans", scans.size()},
               {"points", countsJson(accumulated.counts)},
               {"scales", scales},
               {"tiles", update.tiles},
               {"tiles_written", update.tiles_written},
               {"bytes", bytes},
               {"seconds", seconds}});
    return;
  }
  std::cout << input.map << ": " << summaryOf(scans, accumulated.counts) << " added, Gaussians per scale "
            << perScale(update.gaussians) << ", " << update.tiles_written << " of " << update.tiles
            << " tiles written, " << humanBytes(bytes) << ", " << std::round(seconds * 100.0) / 100.0 << " s\n";
}

}  // namespace gaussmap::app
