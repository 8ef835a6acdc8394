// SPDX-License-Identifier: BSD-3-Clause
// gaussmap export MAP OUT.pcd: the Gaussians as a point cloud that every PCL tool opens.
#include <iostream>

#include "common.h"
#include "gaussmap/io/map_pcd.h"

namespace gaussmap::app {
namespace {

struct ExportCommand {
  std::string map;
  Output output;
  int scale = -1;
};

void run(const ExportCommand& options) {
  const std::filesystem::path target = options.output.path;
  if (target.extension() != ".pcd") throw UsageError(options.output.path + ": the name must end in .pcd");
  checkOutput(options.output, {options.map});
  const GaussianMap<3> map = loadAnyMap(options.map);
  ExportOptions to;
  to.overwrite = options.output.force;
  if (options.scale >= 0) to.scale = options.scale;
  if (options.scale >= map.scales())
    throw UsageError("--scale " + std::to_string(options.scale) + ": the map has the scales 0 to " +
                     std::to_string(map.scales() - 1));
  saveMapPcd(map, target, to);
  std::size_t count = 0;
  for (int s = 0; s < map.scales(); ++s) count += options.scale < 0 || options.scale == s ? map.gaussianCount(s) : 0;
  std::cout << options.output.path << ": " << count << " Gaussians, " << humanBytes(std::filesystem::file_size(target))
            << '\n';
}

}  // namespace

void addExport(CLI::App& app) {
  auto options = std::make_shared<ExportCommand>();
  CLI::App* command = app.add_subcommand("export", "Write the Gaussians of a map as a PCD file");
  command->footer(
      "Fields: x y z covariance[6] weight occupancy cell_side scale cell_x cell_y cell_z.\n"
      "Example: gaussmap export street.gmap street.pcd --scale 1");
  command->add_option("map", options->map, "map (.gmap, or PCD of Gaussians)")->required();
  command->add_option("output", options->output.path, "file to write (.pcd)")->required();
  command->add_flag("--force", options->output.force, "replace an existing output");
  command->add_option("--scale", options->scale, "only this scale, 0 = finest")->check(CLI::Range(0, 63));
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
