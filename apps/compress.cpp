// SPDX-License-Identifier: BSD-3-Clause
// gaussmap compress MAP -o OUT --max-error E: detail only where it is needed.
#include "gaussmap/editing/compress.h"

#include <cstdio>

#include "common.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct CompressCommand {
  std::string map;
  Output output;
  double max_error = 0.0;  // [m]
  CompressOptions compress;
  bool json = false;
};

void run(const CompressCommand& options) {
  checkMapOutput(options.output, {options.map});
  const double start = now();
  MapMetadata metadata;
  const GaussianMap<3> whole = loadAnyMap(options.map, &metadata);
  if (whole.isCompressed())
    throw std::runtime_error(options.map + ": is compressed already, compress the map that it was made from");
  const GaussianMap<3> map = compress(whole, options.max_error, options.compress);
  metadata.erase("error_curves");  // of scales that are no longer whole
  addHistory(metadata, {{"command", "compress"},
                        {"version", GAUSSMAP_VERSION},
                        {"max_error", options.max_error},
                        {"seed", options.compress.seed}});
  saveMap<3>(map, options.output.path, metadata,
             {options.output.force, SaveOptions().compression, options.compress.threads});
  const std::uintmax_t before = std::filesystem::file_size(options.map);
  const std::uintmax_t bytes = std::filesystem::file_size(options.output.path);
  Json scales = scalesOf(map);
  for (int s = 0; s < map.scales(); ++s) {
    scales[static_cast<std::size_t>(s)]["cells_before"] = whole.cellCount(s);
    scales[static_cast<std::size_t>(s)]["gaussians_before"] = whole.gaussianCount(s);
  }
  if (options.json) {
    printJson({{"map", options.output.path},
               {"max_error", options.max_error},
               {"scales", scales},
               {"bytes", bytes},
               {"bytes_before", before},
               {"seconds", now() - start}});
    return;
  }
  std::printf("%s: max error %g m, %s of %s\n", options.output.path.c_str(), options.max_error,
              humanBytes(bytes).c_str(), humanBytes(before).c_str());
  std::printf("%5s %10s %10s %10s %10s %10s\n", "scale", "cell [m]", "cells", "of", "Gaussians", "of");
  for (const Json& scale : scales)
    std::printf("%5d %10g %10zu %10zu %10zu %10zu\n", scale["scale"].get<int>(), scale["cell_side"].get<double>(),
                scale["cells"].get<std::size_t>(), scale["cells_before"].get<std::size_t>(),
                scale["gaussians"].get<std::size_t>(), scale["gaussians_before"].get<std::size_t>());
}

}  // namespace

void addCompress(CLI::App& app) {
  auto options = std::make_shared<CompressCommand>();
  CLI::App* command = app.add_subcommand("compress", "Delete detail under coarse cells that are good enough alone");
  command->footer(
      "From the coarsest scale down, everything finer under a cell goes if, for each of its Gaussians, 95 % of its\n"
      "samples lie within --max-error of the finest scale's means, and every such mean under the cell lies within\n"
      "--max-error of the ellipsoid (95 % of the mass) of one of them. What stays, stays as it was. The result takes\n"
      "no more scans and cannot be refined: refine first.\n"
      "Example: gaussmap compress street.gmap -o small.gmap --max-error 0.2");
  command->add_option("map", options->map, "map (.gmap, or PCD of Gaussians)")->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  command->add_option("--max-error", options->max_error, "how far a coarse cell may be from the finest scale [m]")
      ->check(numberBetween(1e-9, 1e9))
      ->required();
  addSeed(*command, options->compress.seed, "of the samples");
  addThreads(*command, options->compress.threads);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
