// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iostream>
#include <limits>
#include <optional>

#include "commands/dropped_fields.h"
#include "commands/pcd2map/pcd2map.h"
#include "commands/pcd2map/scan_report.h"
#include "common/box.h"
#include "common/progress_bar.h"
#include "common/report.h"
#include "gaussmap/io/gmap/map_reader.h"
#include "gaussmap/io/gmap/map_update.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/map/queries.h"
#include "map/neighbour_keys.h"

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

template <int D>
AccumulatedScans<D> accumulate(const Pcd2mapOptions& options, const Scans& scans, double resolution) {
  ProgressBar bar;
  AccumulateOptions reading = accumulateOptions(options.input, resolution, options.budget.refine.threads);
  if (D == 2) reading = withSlice(reading, options.slice, options.input.crop);
  AccumulatedScans<D> accumulated = readChecked<D>(scans, options.slice, [&](const Scans& checked) {
    return accumulateScans<D>(checked, reading, [&](const AccumulateProgress& progress) { bar.show(progress); });
  });
  requirePoints(accumulated.counts, scans, options.slice);
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
  std::cout << options.update << ": " << summaryOf(scans, counts, options.slice) << " added, Gaussians per scale "
            << perScale(update.gaussians) << ", " << update.tiles_written << " of " << update.tiles
            << " tiles written, " << humanBytes(bytes) << ", " << secondsText(seconds) << " s\n";
}

/// Returns the names of scans that have no point in or beside a coarsest cell of the map.
template <int D>
std::vector<std::string> farScans(const FileScans& scans, const GaussianMap<D>& coarse) {
  constexpr double kFarthest = 2147483000.0;  // cells: beyond, a point has no key
  const int s = coarse.scales() - 1;
  std::vector<std::string> far;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::vector<Eigen::Vector3d> points = scans.sample(i);
    const bool is_near = std::any_of(points.begin(), points.end(), [&](const Eigen::Vector3d& in_space) {
      const Vector<D> point = in_space.head<D>();
      if (!(point.cwiseAbs().maxCoeff() < kFarthest * coarse.grid().side(s))) return false;
      bool found = false;
      detail::forKeysAround(coarse.grid().keyOf(point, s),
                            [&](const CellKey<D>& near) { found = found || coarse.find(near, s); });
      return found;
    });
    if (!is_near && !points.empty()) far.push_back(scans.files()[i].path.string());
  }
  return far;
}

template <int D>
void warnOfFarScans(const FileScans& scans, const std::string& map) {
  const Vector<D> infinite = Vector<D>::Constant(std::numeric_limits<double>::infinity());
  MapReader<D> reader(map);
  const GaussianMap<D> coarse = reader.load({-infinite, infinite}, reader.grid().scales() - 1);
  const auto extent = extentOf<D>(coarse);
  const std::vector<std::string> far = farScans<D>(scans, coarse);
  if (far.empty() || !extent) return;
  warn(far.front() + (far.size() > 1 ? " and " + std::to_string(far.size() - 1) + " more" : "") +
       ": no point lies near the map " + map + ", which covers " + textOf(*extent) +
       "; check the pose, --frame and the units");
}

void warnOfRepeats(const MapUpdate& update, const std::string& map) {
  // Of a scan that is added again, only the cells that no other scan hit show it. Single points of different scans can
  // be equal by chance, because many sensors round their ranges.
  constexpr std::size_t kFewest = 3;
  constexpr double kDenseShare = 0.001, kShare = 0.3;
  const auto exceeds = [](std::size_t some, std::size_t all, double share) {
    return some >= kFewest && static_cast<double>(some) > share * static_cast<double>(all);
  };
  if (!exceeds(update.dense_cells_repeated, update.dense_cells, kDenseShare) &&
      !exceeds(update.cells_repeated, update.cells_added_to, kShare))
    return;
  warn(std::to_string(update.cells_repeated) + " of " + std::to_string(update.cells_added_to) +
       " cells with new points held exactly these points already, so a scan is already in " + map +
       " and its points now count twice; if that is not wanted, build the map again without it");
}

template <int D>
void update(const Pcd2mapOptions& options) {
  const double start = now();
  const MapOptions map = growingMapOptions<D>(options.update);
  const MapMetadata before = loadMetadata(options.update);
  const Recorded recorded = recordedIn(before);
  const FileScans scans = openScans(options.input, options.budget.refine.threads);
  noteDroppedFields(scans);
  const AccumulatedScans<D> accumulated = accumulate<D>(options, scans, map.resolution);

  warnOfCoordinates(scans, map.resolution);
  warnOfFarScans<D>(scans, options.update);

  BudgetInput merging = options.budget;
  if (!merging.cost) merging.cost = recorded.cost;
  UpdateOptions updating;
  updating.budget = options.update_budget ? options.update_budget : recorded.budget;
  updating.merge_cost = mergeCost(merging);
  updating.threads = options.budget.refine.threads;
  const std::vector<FileSystem> systems = coordinateSystemsOf(scans);
  const std::string system = systems.empty() ? "" : systems.front().system;
  if (const auto of_map = before.find(kCoordinateSystemEntry);
      !system.empty() && of_map != before.end() && of_map->second != system)
    warn(nameOf(scans) + ": the coordinate reference system differs from that of " + options.update +
         ", which the map keeps; convert the scans if the systems are not the same");
  Json step = historyOf(scans, accumulated.counts, options.slice);
  step["update"] = true;
  step["method"] = "agglomerate";
  if (updating.budget) step["budget"] = *updating.budget;
  if (merging.cost) step["cost"] = *merging.cost;
  const MapUpdate update = updateMap<D>(options.update, accumulated.moments, updating, [&](MapMetadata& metadata) {
    metadata.erase("error_curves");  // they describe the old map
    addHistory(metadata, step);
    if (!system.empty()) metadata.emplace(kCoordinateSystemEntry, system);
  });
  warnOfRepeats(update, options.update);
  report(options, scans, accumulated.counts, update, start);
}

}  // namespace

void updateFromScans(const Pcd2mapOptions& options) {
  const int dimensions = dimensionsOf(options.update);
  if (dimensions == 3 && (options.planar || !options.slice.empty()) && isMap(options.update))
    throw UsageError(std::string(options.planar ? "--planar" : "--slice") + ": " + options.update +
                     " is a 3-D map; the option is for planar maps only");
  forDimensions(dimensions, [&](auto d) { update<d()>(options); });
}

}  // namespace gaussmap::app
