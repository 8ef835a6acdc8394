// SPDX-License-Identifier: BSD-3-Clause
// gaussmap info MAP: what is in a map file.
#include <algorithm>
#include <cstdio>
#include <iostream>

#include "common.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/map/queries.h"
#include "plot.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct InfoOptions {
  std::string map;
  Output plot;
  bool json = false;
};

Json vectorOf(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// {"command": "refine", "budget": 3.0} -> "command refine, budget 3.0"
std::string sentenceOf(const Json& step) {
  if (step.is_string()) return step.get<std::string>();
  if (!step.is_object()) return step.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string sentence;
  for (const auto& [name, value] : step.items())
    sentence += (sentence.empty() ? "" : ", ") + name + " " + sentenceOf(value);
  return sentence;
}

/// Whether more scans can be added, and why not.
std::string stateOf(const GaussianMap<3>& map, const MapMetadata& metadata) {
  const auto final_error = metadata.find(kFinalEntry);
  if (final_error != metadata.end()) return "final (takes no more scans): " + final_error->second;
  if (map.isCompressed()) return "compressed: detail only where it is needed (takes no more scans)";
  const std::string occupancy = map.hasOccupancy() ? ", with occupancy" : "";
  return (map.canGrow() ? "exact moments at the finest scale (takes more scans)" : "Gaussians only (final)") +
         occupancy;
}

/// Adds to each scale what of it is the finest that the map has there.
void addLeaves(const GaussianMap<3>& map, Json& scales) {
  const double all = map.weight(map.scales() - 1);
  for (int s = 0; s < map.scales(); ++s) {
    const LeafCounts counts = leafCounts<3>(map, s);
    Json& scale = scales[static_cast<std::size_t>(s)];
    scale["leaf_cells"] = counts.cells;
    scale["leaf_gaussians"] = counts.gaussians;
    scale["leaf_share"] = all > 0.0 ? counts.weight / all : 0.0;
  }
}

bool isCurve(const Json& curve) {
  if (!curve.is_object() || !curve.value("scale", Json()).is_number_integer()) return false;
  const Json points = curve.value("points", Json());
  return points.is_array() && !points.empty() && std::all_of(points.begin(), points.end(), [](const Json& point) {
           return point.is_object() && point.value("gaussians", Json()).is_number_unsigned() &&
                  point["gaussians"] > 0 && point.value("q95", Json()).is_number() &&
                  point.value("mean", Json()).is_number();
         });
}

/// The error curves that the map was refined by; empty if there are none, or what is there is something else.
Json curvesOf(const MapMetadata& metadata) {
  const auto entry = metadata.find("error_curves");
  const Json curves = entry == metadata.end() ? Json() : Json::parse(entry->second, nullptr, false);
  return curves.is_array() && std::all_of(curves.begin(), curves.end(), isCurve) ? curves : Json::array();
}

void printCurves(const Json& curves) {
  for (const Json& curve : curves) {
    std::printf("error curve of scale %d, Gaussians: 95 %% / mean [m] ", curve.at("scale").get<int>());
    for (const Json& point : curve.at("points"))
      std::printf("  %zu: %.3g / %.3g", point.at("gaussians").get<std::size_t>(), point.at("q95").get<double>(),
                  point.at("mean").get<double>());
    std::printf("\n");
  }
}

void printInfo(const InfoOptions& options) {
  if (!options.plot.path.empty()) checkOutput(options.plot, {options.map});
  MapMetadata metadata;
  const GaussianMap<3> map = loadAnyMap(options.map, &metadata);
  const Json curves = curvesOf(metadata);
  if (!options.plot.path.empty()) {
    if (curves.empty()) throw std::runtime_error(options.map + ": has no error curves; gaussmap refine makes them");
    plotCurves(curves, options.plot.path);
  }
  const bool is_gmap = isGmap(options.map);
  const MapFileSize size =
      is_gmap ? mapFileSize(options.map) : MapFileSize{std::filesystem::file_size(options.map), {}};
  Json scales = scalesOf(map);
  for (int s = 0; s < map.scales() && is_gmap; ++s) {
    const auto index = static_cast<std::size_t>(s);
    const std::uintmax_t bytes = index < size.scale_tiles.size() ? size.scale_tiles[index] : 0;
    const double area = static_cast<double>(map.cellCount(s)) * map.grid().side(s) * map.grid().side(s);
    scales[index]["bytes"] = bytes;
    const bool none = map.cellCount(s) == 0;
    scales[index]["bytes_per_gaussian"] = none ? 0.0 : double(bytes) / double(map.gaussianCount(s));
    scales[index]["bytes_per_square_metre"] = none ? 0.0 : double(bytes) / area;
  }
  addLeaves(map, scales);
  const auto extent = extentOf<3>(map);
  if (options.json) {
    Json info = {{"map", options.map},
                 {"resolution", map.options().resolution},
                 {"ratio", map.options().ratio},
                 {"noise", map.options().noise},
                 {"finest", map.canGrow() || !map.scale(0).moments.empty() ? "moments" : "gaussians"},
                 {"takes_scans", map.canGrow()},
                 {"final", metadata.count(kFinalEntry) > 0},
                 {"compressed", map.isCompressed()},
                 {"occupancy", map.hasOccupancy()},
                 {"scales", scales},
                 {"bytes", size.file}};
    if (extent) info["extent"] = {{"low", vectorOf(extent->low)}, {"high", vectorOf(extent->high)}};
    Json& free_text = info["metadata"] = Json::object();
    for (const auto& [name, value] : metadata) {
      const Json parsed = Json::parse(value, nullptr, false);
      free_text[name] = parsed.is_discarded() ? Json(value) : parsed;
    }
    printJson(info);
    return;
  }
  std::printf("%s: %s, %s\n", options.map.c_str(), humanBytes(size.file).c_str(), stateOf(map, metadata).c_str());
  std::printf("ratio %d, noise floor %g m", map.options().ratio, map.options().noise);
  if (extent)
    std::printf(", extent [%.2f %.2f %.2f] .. [%.2f %.2f %.2f] m", extent->low.x(), extent->low.y(), extent->low.z(),
                extent->high.x(), extent->high.y(), extent->high.z());
  std::printf("\n%5s %10s %10s %10s %12s %12s %12s\n", "scale", "cell [m]", "cells", "Gaussians", "weight", "bytes",
              "bytes/m^2");
  for (const Json& scale : scales) {
    std::printf("%5d %10g %10zu %10zu %12.0f", scale["scale"].get<int>(), scale["cell_side"].get<double>(),
                scale["cells"].get<std::size_t>(), scale["gaussians"].get<std::size_t>(),
                scale["weight"].get<double>());
    if (is_gmap)
      std::printf(" %12s %12.3g", humanBytes(scale["bytes"].get<std::uintmax_t>()).c_str(),
                  scale["bytes_per_square_metre"].get<double>());
    std::printf("\n");
  }
  if (map.isCompressed())
    for (const Json& scale : scales)
      std::printf("finest at scale %d: %zu cells, %zu Gaussians, %.3g %% of the points\n", scale["scale"].get<int>(),
                  scale["leaf_cells"].get<std::size_t>(), scale["leaf_gaussians"].get<std::size_t>(),
                  100.0 * scale["leaf_share"].get<double>());
  printCurves(curves);
  const auto history = metadata.find("history");
  if (history == metadata.end()) return;
  const Json steps = Json::parse(history->second, nullptr, false);
  if (!steps.is_array()) return;
  for (const Json& step : steps) std::printf("history: %s\n", sentenceOf(step).c_str());
}

}  // namespace

void addInfo(CLI::App& app) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand("info", "Scales, cells, Gaussians, extent and size of a map");
  command->footer(
      "bytes/m^2: compressed bytes per square metre of occupied cells (a cell counts side^2).\n"
      "Example: gaussmap info street.gmap --json");
  command->add_option("map", options->map, "map (.gmap, or PCD of Gaussians)")->required();
  command->add_option("--plot", options->plot.path, "draw the error against the number of Gaussians (.svg)");
  command->add_flag("--force", options->plot.force, "replace an existing plot");
  command->add_flag("--json", options->json, "print for machines");
  command->callback([options] { printInfo(*options); });
}

}  // namespace gaussmap::app
