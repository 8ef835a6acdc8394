// SPDX-License-Identifier: BSD-3-Clause
// gaussmap tiles MAP -o DIR: writes PCD tiles with an index. gaussmap tiles DIR -o MAP: makes a map of such tiles.
#include <cstdio>
#include <memory>

#include "commands/commands.h"
#include "commands/map_task.h"
#include "common/command.h"
#include "common/report.h"
#include "gaussmap/core/error.h"
#include "gaussmap/io/export/map_tiles.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
namespace {

struct TilesCommand : MapTaskOptions {
  int size = TilesOptions().size;
  int scale = 0;
  bool all_scales = false;
  bool floats = false;
};

const Help kTilesHelp = {
    "Convert a map to PCD tiles with an index for Autoware, or such tiles to a map",
    "gaussmap tiles street.gmap -o tiles && gaussmap tiles tiles -o back.gmap",
    R"(Writes tile_X_Y.pcd for every square of --size metres, and pointcloud_map_metadata.yaml with the lower corner of
each tile: the layout of Autoware's dynamic map loading. x y z are the means of the Gaussians, and the other fields
are those of gaussmap export. Far from the origin, where floats would lose a thousandth of a cell, x y z are
doubles. Autoware reads only floats: move the map to an origin near it with gaussmap transform, or use --floats.

If the input is a directory of tiles, the command writes a map. If the tiles contain only the finest scale, the map
has one Gaussian per coarse cell (gaussmap refine adds more). Tiles contain no moments, so the map accepts no more
scans.)"};

void warnOfPrecision(const std::string& folder, const WrittenTiles& tiles, const GaussianMap<3>& map) {
  const std::string rounded = formatted("%.2g m", tiles.rounding);
  if (tiles.doubles)
    warn(folder + ": x y z are doubles (F 8), because floats would round them by " + rounded +
         "; Autoware and PCL's point types read only floats: move the map to an origin near it with gaussmap "
         "transform, or use --floats");
  else if (tiles.rounding > 1e-3 * map.grid().side(0))
    warn(folder + ": x y z are floats, rounded by " + rounded + " (the side of a cell is " +
         formatted("%g m", map.grid().side(0)) + ")");
}

void toTiles(const TilesCommand& command) {
  if (const std::string ending = endingOf(command.output.path); ending == ".gmap" || ending == ".pcd")
    throw UsageError(command.output.path + ": tiles of a map are a directory, whose name must not end in " + ending);
  if (dimensionsOf(command.map) == 2)
    throw FileError(command.map,
                    "is a planar map, but tiles are for localisation with the points of a 3-D lidar; gaussmap export "
                    "writes the Gaussians as one PCD file");
  const GaussianMap<3> map = loadMap<3>(command.map);
  checkScale("--scale", command.scale, map.scales());
  TilesOptions to;
  to.size = command.size;
  to.scale = command.all_scales ? std::nullopt : std::optional<int>(command.scale);
  to.floats = command.floats;
  const WrittenTiles written = saveTiles(command.output.path, map, to);
  warnOfPrecision(command.output.path, written, map);
  if (command.json)
    printJson({{"directory", command.output.path}, {"tiles", written.tiles}, {"gaussians", written.gaussians}});
  else
    std::printf("%s: %zu tiles of %d m, %zu Gaussians\n", command.output.path.c_str(), written.tiles, command.size,
                written.gaussians);
}

void fromTiles(const TilesCommand& command) {
  MapTask task(command, {});
  const GaussianMap<3> map = loadTiles(command.map);
  task.addStep("tiles", {{"directory", command.map}});
  task.save(map);
  if (command.json)
    printJson({{"map", command.output.path}, {"scales", scalesOf(map)}, {"bytes", task.bytes()}});
  else
    std::printf("%s: %zu cells of %g m, %d scales\n", command.output.path.c_str(), map.cellCount(0), map.grid().side(0),
                map.scales());
}

}  // namespace

void addTiles(CLI::App& app) {
  auto options = std::make_shared<TilesCommand>();
  Command command(app, "tiles", kTilesHelp);
  command.text("map", options->map, "map (.gmap, or PCD of Gaussians), or a directory of tiles").required();
  command.output(options->output, "directory, or map file (.gmap), to write");
  command.number("--size", options->size, 1, 1000000, "side of a tile [m]");
  const Option scale = command.scale(options->scale, "scale to write, 0 = finest");
  command
      .flag("--all-scales", options->all_scales,
            "write all scales; a map made of the tiles then has the same coarse scales")
      .excludes(scale);
  command.flag("--floats", options->floats,
               "write x y z as floats even if that rounds them (far from the origin they are doubles by default)");
  command.json(options->json);
  command.files({"map"}, {".gmap", ".pcd"});
  command.files({"--output"}, {".gmap"});
  command.onRun([options] { std::filesystem::is_directory(options->map) ? fromTiles(*options) : toTiles(*options); });
}

}  // namespace gaussmap::app
