// SPDX-License-Identifier: BSD-3-Clause
// gaussmap info MAP: prints the contents of a map file.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "commands/any_map.h"
#include "commands/commands.h"
#include "common/box.h"
#include "common/command.h"
#include "common/json.h"
#include "common/report.h"
#include "drawing/plot.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/map/queries.h"

namespace gaussmap::app {
namespace {

struct InfoCommand {
  std::string map;
  Output plot;
  bool json = false;
};

const Help kInfoHelp = {
    "Print scales, cells, Gaussians, extent and size of a map", "gaussmap info street.gmap --json",
    R"(bytes/m^2: compressed bytes per square metre of occupied cells. The area of a cell is the square of its side.)"};

/// A map and the information in its file.
template <int D>
struct MapInfo {
  GaussianMap<D> map;
  MapMetadata metadata;
  std::optional<Box<D>> extent;
  std::vector<ErrorCurve> curves;
  std::uintmax_t bytes = 0;
  bool has_tile_sizes = false;
  Json scales;
};

template <int D>
Json vectorOf(const Vector<D>& v) {
  Json json = Json::array();
  for (int axis = 0; axis < D; ++axis) json.push_back(v(axis));
  return json;
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

/// Returns whether the map accepts more scans, and if not, why.
template <int D>
std::string stateOf(const GaussianMap<D>& map, const MapMetadata& metadata) {
  const auto final_error = metadata.find(kFinalEntry);
  if (final_error != metadata.end()) return "final (accepts no more scans): " + final_error->second;
  if (map.isCompressed()) return "compressed: detail only where it is needed (accepts no more scans)";
  const std::string occupancy = map.hasOccupancy() ? ", with occupancy" : "";
  return (map.acceptsScans() ? "exact moments at the finest scale (accepts more scans)" : "Gaussians only (final)") +
         occupancy;
}

/// Adds to each scale the cells, Gaussians and weight of its leaves.
template <int D>
void addLeaves(const GaussianMap<D>& map, Json& scales) {
  const double all = map.weight(map.scales() - 1);
  for (int s = 0; s < map.scales(); ++s) {
    const LeafCounts counts = leafCounts<D>(map, s);
    Json& scale = scales[static_cast<std::size_t>(s)];
    scale["leaf_cells"] = counts.cells;
    scale["leaf_gaussians"] = counts.gaussians;
    scale["leaf_share"] = all > 0.0 ? counts.weight / all : 0.0;
  }
}

/// Adds to each scale the size of its tiles [bytes].
template <int D>
void addBytes(const GaussianMap<D>& map, const MapFileSize& size, Json& scales) {
  for (int s = 0; s < map.scales(); ++s) {
    const auto index = static_cast<std::size_t>(s);
    const std::uintmax_t bytes = index < size.scale_tiles.size() ? size.scale_tiles[index] : 0;
    const double area = static_cast<double>(map.cellCount(s)) * map.grid().side(s) * map.grid().side(s);
    const bool is_empty = map.cellCount(s) == 0;
    scales[index]["bytes"] = bytes;
    scales[index]["bytes_per_gaussian"] = is_empty ? 0.0 : double(bytes) / double(map.gaussianCount(s));
    scales[index]["bytes_per_square_metre"] = is_empty ? 0.0 : double(bytes) / area;
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

/// Returns the error curves of the refinement; empty if the metadata has no valid curves.
std::vector<ErrorCurve> curvesOf(const MapMetadata& metadata) {
  const Json json = jsonEntry(metadata, "error_curves");
  std::vector<ErrorCurve> curves;
  if (!json.is_array() || !std::all_of(json.begin(), json.end(), isCurve)) return curves;
  for (const Json& one : json) {
    ErrorCurve& curve = curves.emplace_back();
    curve.scale = one["scale"].get<int>();
    for (const Json& point : one["points"])
      curve.points.push_back({point["gaussians"].get<std::size_t>(), 0.0, point["q95"].get<double>(),
                              point["mean"].get<double>()});  // q99 is not shown
  }
  return curves;
}

template <int D>
MapInfo<D> readInfo(const std::string& path) {
  MapInfo<D> info;
  info.map = loadMap<D>(path, &info.metadata);
  info.curves = curvesOf(info.metadata);
  info.extent = extentOf<D>(info.map);
  info.scales = scalesOf(info.map);
  info.has_tile_sizes = isGmap(path);
  if (info.has_tile_sizes) {
    const MapFileSize size = mapFileSize(path);
    addBytes(info.map, size, info.scales);
    info.bytes = size.file;
  } else {
    info.bytes = std::filesystem::file_size(path);
  }
  addLeaves(info.map, info.scales);
  return info;
}

/// Returns the area of the finest cells [m^2].
double areaOf(const GaussianMap<2>& map) {
  return static_cast<double>(map.cellCount(0)) * map.grid().side(0) * map.grid().side(0);
}

template <int D>
Json jsonOf(const MapInfo<D>& info, const std::string& path) {
  const GaussianMap<D>& map = info.map;
  Json json = {{"map", path}};
  if constexpr (D == 2) json.update(Json{{"dimensions", 2}, {"area", areaOf(map)}});
  json.update(Json{{"resolution", map.options().resolution},
                   {"ratio", map.options().ratio},
                   {"noise", map.options().noise},
                   {"finest", map.acceptsScans() || !map.scale(0).moments.empty() ? "moments" : "gaussians"},
                   {"takes_scans", map.acceptsScans()},
                   {"final", info.metadata.count(kFinalEntry) > 0},
                   {"compressed", map.isCompressed()},
                   {"occupancy", map.hasOccupancy()},
                   {"scales", info.scales},
                   {"bytes", info.bytes}});
  if (info.extent) json["extent"] = {{"low", vectorOf<D>(info.extent->low)}, {"high", vectorOf<D>(info.extent->high)}};
  Json& free_text = json["metadata"] = Json::object();
  for (const auto& [name, value] : info.metadata) {
    const Json parsed = Json::parse(value, nullptr, false);
    free_text[name] = parsed.is_discarded() ? Json(value) : parsed;
  }
  return json;
}

template <int D>
void printScales(const MapInfo<D>& info) {
  std::printf("\n%5s %10s %10s %10s %12s %12s %12s\n", "scale", "cell [m]", "cells", "Gaussians", "weight", "bytes",
              "bytes/m^2");
  for (const Json& scale : info.scales) {
    std::printf("%5d %10g %10zu %10zu %12.0f", scale["scale"].get<int>(), scale["cell_side"].get<double>(),
                scale["cells"].get<std::size_t>(), scale["gaussians"].get<std::size_t>(),
                scale["weight"].get<double>());
    if (info.has_tile_sizes)
      std::printf(" %12s %12.3g", humanBytes(scale["bytes"].get<std::uintmax_t>()).c_str(),
                  scale["bytes_per_square_metre"].get<double>());
    std::printf("\n");
  }
  if (!info.map.isCompressed()) return;
  for (const Json& scale : info.scales)
    std::printf("leaves of scale %d: %zu cells, %zu Gaussians, %.3g %% of the points\n", scale["scale"].get<int>(),
                scale["leaf_cells"].get<std::size_t>(), scale["leaf_gaussians"].get<std::size_t>(),
                100.0 * scale["leaf_share"].get<double>());
}

template <int D>
void print(const MapInfo<D>& info, const std::string& path) {
  std::printf("%s: %s, %s\n", path.c_str(), humanBytes(info.bytes).c_str(), stateOf(info.map, info.metadata).c_str());
  if (D == 2) std::printf("planar, ");
  std::printf("ratio %d, noise floor %g m", info.map.options().ratio, info.map.options().noise);
  if (info.extent) std::printf(", extent %s", textOf<D>(*info.extent).c_str());
  if constexpr (D == 2) std::printf(", area of the finest cells %.4g m^2", areaOf(info.map));
  printScales(info);
  for (const ErrorCurve& curve : info.curves) {
    std::printf("error curve of scale %d, Gaussians: 95 %% / mean [m] ", curve.scale);
    for (const ErrorPoint& point : curve.points)
      std::printf("  %zu: %.3g / %.3g", point.gaussians, point.q95, point.mean);
    std::printf("\n");
  }
  if (const auto system = info.metadata.find(kCoordinateSystemEntry); system != info.metadata.end())
    std::printf("coordinate reference system: %s\n", nameOfSystem(system->second).c_str());
  const Json steps = jsonEntry(info.metadata, "history");
  if (!steps.is_array()) return;
  for (const Json& step : steps) std::printf("history: %s\n", sentenceOf(step).c_str());
}

template <int D>
void run(const InfoCommand& command) {
  if (!command.plot.path.empty()) checkOutput(command.plot, {command.map});
  refuseOtherKinds(command.plot.path, "a picture", {".svg"});
  const MapInfo<D> info = readInfo<D>(command.map);
  if (!command.plot.path.empty()) {
    if (info.curves.empty())
      throw std::runtime_error(command.map + ": has no error curves; use gaussmap refine to measure them");
    plotCurves(info.curves, command.plot.path);
  }
  if (command.json)
    printJson(jsonOf(info, command.map));
  else
    print(info, command.map);
}

}  // namespace

void addInfo(CLI::App& app) {
  auto options = std::make_shared<InfoCommand>();
  Command command(app, "info", kInfoHelp);
  command.map(options->map);
  command.text("--plot", options->plot.path, "draw the error against the number of Gaussians (.svg)");
  command.force(options->plot.force, "replace an existing plot");
  command.json(options->json);
  command.files({"--plot"}, {".svg"});
  command.onRun([options] { forMap(options->map, [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
