// SPDX-License-Identifier: BSD-3-Clause
#include "commands/view_options.h"

#include "common/command.h"
#include "viewer/key_help.h"

namespace gaussmap::app {

void addViewOptions(CLI::App& program, ViewCommand& options) {
  Command command(program,
                  {kViewSummary, "gaussmap view street.gmap --scale 1 --color normal --png street.png --size 1600x900",
                   std::string("Keys:\n") + detail::kKeyHelp});
  command.text("map", options.map, "map (.gmap, or PCD of Gaussians or of segments), or mesh (.ply)").required();
  command.texts("cloud", options.cloud.paths, "PCD files or directories, drawn over the map");
  addScanOptions(command, options.cloud);
  command.scale(options.scale, "scale to show, 0 = finest; default: the finest scale with at most 200,000 Gaussians");
  command.flag("--leaves", options.leaves, "show all leaves of a compressed map");
  command.choice("--color", options.colour,
                 {"height", "scale", "normal", "weight", "occupancy", "error", "contribution", "cell-error"},
                 "colour of the Gaussians, default: height; error = distance to CLOUD, or else to the finer scales; "
                 "contribution = to the error of the coarse cell above the Gaussian; cell-error = error of the cell");
  command.number("--sigma", options.view.sigma, 0.01, 100.0, "half axes of the ellipsoids, in standard deviations");
  command.flag("--cells", options.view.cells, "draw the occupied cells as boxes");
  command.flag("--hierarchy", options.view.hierarchy,
               "draw all scales, one above the other, with links to the children");
  command.text("--mesh", options.mesh, "surface to draw with the map (.ply)").rare();
  command.choice("--up", options.up, Command::wordsOf(kUpAxes), "axis that points up");
  command
      .text("--view", options.from,
            "top, iso, or the direction x,y,z from the map to the eye; default: iso; planar maps without --hierarchy: "
            "top")
      .hideDefault();
  command.number("--zoom", options.view.view.zoom, 0.01, 1000.0, "magnification, 1 = the whole map");
  command.number("--span", options.span, 0.001, 1e6, "height of the picture [m], measured at the point of --at").rare();
  command.excludes("--span", {"--zoom"});
  command.numbers("--at", options.at, 3, -1e9, 1e9, "point to look at [m]; default: the middle of the map")
      .type("X Y Z");
  command.text("--png", options.png.path, "save a picture instead of opening a window; needs no display");
  command.text("--size", options.size, "size of the picture or window [pixels]");
  command.force(options.png.force, "replace an existing picture");
  command.files({"map"}, {".gmap", ".pcd", ".ply"});
  command.files({"--mesh"}, {".ply"});
  command.files({"cloud"}, {".pcd"});
  command.files({"--png"}, {".png"});
}

}  // namespace gaussmap::app
