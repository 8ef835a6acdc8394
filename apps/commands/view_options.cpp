// SPDX-License-Identifier: BSD-3-Clause
#include "commands/view_options.h"

#include "common/command.h"
#include "viewer/key_help.h"

namespace gaussmap::app {

void addViewOptions(CLI::App& program, ViewCommand& options) {
  Command command(program,
                  {kViewSummary, "gaussmap view street.gmap --scale 1 --color normal --png street.png --size 1600x900",
                   std::string("Keys:\n") + detail::kKeyHelp});
  command.text("map", options.map, "map (.gmap, or PCD of Gaussians or of segments)").required();
  command.texts("cloud", options.cloud.paths, "PCD files or directories, shown over the map");
  addScanOptions(command, options.cloud);
  command.scale(options.scale, "which scale, 0 = finest; default: the finest of at most 200,000 Gaussians");
  command.flag("--leaves", options.leaves, "all leaves of a compressed map");
  command.choice("--color", options.colour, {"height", "scale", "normal", "weight", "occupancy", "error"},
                 "height (default), scale, normal, weight, occupancy, or error: distance to the CLOUD, or without a "
                 "CLOUD to the finer scales");
  command.number("--sigma", options.view.sigma, 0.01, 100.0, "half axes of the ellipsoids, in standard deviations");
  command.flag("--cells", options.view.cells, "draw the occupied cells as boxes");
  command.flag("--hierarchy", options.view.hierarchy,
               "draw all scales, one above the other, with links to the children");
  command.choice("--up", options.up, Command::wordsOf(kUpAxes), "the axis that points up");
  command.text("--view", options.from, "top, iso, or x,y,z: the direction from the map to the eye");
  command.number("--zoom", options.view.view.zoom, 0.01, 1000.0, "1 = all of the map");
  command.numbers("--at", options.at, 3, -1e9, 1e9, "the point to look at [m]; default: the middle").type("X Y Z");
  command.text("--png", options.png.path, "save a picture instead of opening a window; needs no display");
  command.text("--size", options.size, "size of the picture or window [pixels]");
  command.force(options.png.force, "replace an existing picture");
  command.files({"map"}, {".gmap", ".pcd"});
  command.files({"cloud"}, {".pcd"});
  command.files({"--png"}, {".png"});
}

}  // namespace gaussmap::app
