// SPDX-License-Identifier: BSD-3-Clause
// gaussmap tiles MAP -o DIR: PCD tiles with an index; gaussmap tiles DIR -o MAP: and back.
#include <cstdio>

#include "common.h"
#include "gaussmap/io/export/map_tiles.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct TilesCommand {
  std::string input;
  Output output;
  int size = TilesOptions().size;
  int scale = 0;
  bool all_scales = false;
  bool json = false;
};

void toTiles(const TilesCommand& options) {
  const GaussianMap<3> map = loadAnyMap(options.input);
  if (options.scale >= map.scales())
    throw UsageError("--scale " + std::to_string(options.scale) + ": the map has the scales 0 to " +
                     std::to_string(map.scales() - 1));
  TilesOptions to;
  to.size = options.size;
  to.scale = options.all_scales ? std::nullopt : std::optional<int>(options.scale);
  const WrittenTiles written = saveTiles(map, options.output.path, to);
  if (options.json)
    printJson({{"directory", options.output.path}, {"tiles", written.tiles}, {"gaussians", written.gaussians}});
  else
    std::printf("%s: %zu tiles of %d m, %zu Gaussians\n", options.output.path.c_str(), written.tiles, options.size,
                written.gaussians);
}

void fromTiles(const TilesCommand& options) {
  checkMapOutput(options.output, {});
  const GaussianMap<3> map = loadTiles(options.input);
  MapMetadata metadata;
  addHistory(metadata, {{"command", "tiles"}, {"version", GAUSSMAP_VERSION}, {"directory", options.input}});
  saveMap<3>(map, options.output.path, metadata, {options.output.force, SaveOptions().compression, 0});
  if (options.json) {
    printJson({{"map", options.output.path},
               {"scales", scalesOf(map)},
               {"bytes", std::filesystem::file_size(options.output.path)}});
    return;
  }
  std::printf("%s: %zu cells of %g m, %d scales\n", options.output.path.c_str(), map.cellCount(0), map.grid().side(0),
              map.scales());
}

}  // namespace

void addTiles(CLI::App& app) {
  auto options = std::make_shared<TilesCommand>();
  CLI::App* command = app.add_subcommand("tiles", "A map as PCD tiles with an index, as Autoware loads them; and back");
  command->footer(
      "Writes tile_X_Y.pcd for every square of --size metres and pointcloud_map_metadata.yaml, which gives the lower\n"
      "corner of each: the layout of Autoware's dynamic map loading. x y z are the means of the finest scale; the "
      "other\n"
      "fields are those of gaussmap export. Given such a directory, it makes a map of it; from the finest scale alone\n"
      "with one Gaussian in each coarser cell (gaussmap refine adds more). Sums of points are not in tiles: the map\n"
      "takes no more scans.\n"
      "Example: gaussmap tiles street.gmap -o tiles && gaussmap tiles tiles -o back.gmap");
  command->add_option("map", options->input, "map (.gmap, or PCD of Gaussians), or a directory of tiles")->required();
  addOutput(*command, options->output, "directory, or map file (.gmap), to write");
  command->add_option("--size", options->size, "side of a tile [m]")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  CLI::Option* scale = command->add_option("--scale", options->scale, "the scale that is written, 0 = finest")
                           ->check(CLI::Range(0, 63))
                           ->capture_default_str();
  command
      ->add_flag("--all-scales", options->all_scales, "write all scales, so that nothing is made anew on the way back")
      ->excludes(scale);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options] {
    if (std::filesystem::is_directory(options->input))
      fromTiles(*options);
    else
      toTiles(*options);
  });
}

}  // namespace gaussmap::app
