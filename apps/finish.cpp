// SPDX-License-Identifier: BSD-3-Clause
// gaussmap finish MAP -o OUT: a map for use, not for growth.
#include <cstdio>

#include "common.h"
#include "gaussmap/io/pcd/map_pcd.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct FinishCommand {
  std::string map;
  Output output;
  int finest_scale = 0;
  int compression = 15;  // zstd level: written once, read often
  int threads = 0;
  bool json = false;
};

void run(const FinishCommand& options) {
  checkMapOutput(options.output, {options.map});
  const double start = now();
  MapMetadata metadata;
  GaussianMap<3> map = loadAnyMap(options.map, &metadata);
  if (metadata.count(kFinalEntry) > 0)
    throw std::runtime_error(options.map + ": is final already, finish the map that it was made from");
  if (options.finest_scale >= map.scales())
    throw UsageError("--finest-scale " + std::to_string(options.finest_scale) + ": the map has the scales 0 to " +
                     std::to_string(map.scales() - 1));
  map = finish<3>(map, options.finest_scale);
  Json step = {{"command", "finish"}, {"version", GAUSSMAP_VERSION}};
  if (options.finest_scale > 0) {
    step["finest_scale"] = options.finest_scale;
    metadata.erase("error_curves");  // of scales against one that is no longer there
  }
  addHistory(metadata, step);
  saveMap<3>(map, options.output.path, metadata,
             {options.output.force, options.compression, options.threads, Precision::Finished});

  const std::uintmax_t before = std::filesystem::file_size(options.map);
  const std::uintmax_t bytes = std::filesystem::file_size(options.output.path);
  std::size_t gaussians = 0;
  for (int s = 0; s < map.scales(); ++s) gaussians += map.gaussianCount(s);
  const double per_gaussian = gaussians > 0 ? static_cast<double>(bytes) / static_cast<double>(gaussians) : 0.0;
  const std::string error = loadMetadata(options.output.path).at(kFinalEntry);
  if (options.json) {
    printJson({{"map", options.output.path},
               {"scales", scalesOf(map)},
               {"bytes", bytes},
               {"bytes_before", before},
               {"bytes_per_gaussian", per_gaussian},
               {"error", error},
               {"seconds", now() - start}});
    return;
  }
  std::printf("%s: %zu Gaussians, %s of %s, %.1f bytes a Gaussian; %s\n", options.output.path.c_str(), gaussians,
              humanBytes(bytes).c_str(), humanBytes(before).c_str(), per_gaussian, error.c_str());
}

}  // namespace

void addFinish(CLI::App& app) {
  auto options = std::make_shared<FinishCommand>();
  CLI::App* command = app.add_subcommand("finish", "A small map for use, not for growth");
  command->footer(
      "Drops what only growth needs and rounds the rest to what the spread of a Gaussian allows, which is nowhere "
      "less\n"
      "than the noise floor: means by at most 1/16 standard deviation along each axis (the other coordinates fixed),\n"
      "the standard deviation in every direction by at most 5 %, weights and log-odds by at most 1/32. Covariances "
      "stay\n"
      "positive definite. The result takes no more scans and merges no longer exactly: keep the map it was made from.\n"
      "Example: gaussmap finish street.gmap -o robot.gmap");
  command->add_option("map", options->map, "map (.gmap, or PCD of Gaussians)")->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  command->add_option("--finest-scale", options->finest_scale, "leave out finer scales")
      ->check(CLI::Range(0, 63))
      ->capture_default_str();
  command->add_option("--compression", options->compression, "zstd level; higher: smaller, slower to write")
      ->check(CLI::Range(1, 19))
      ->capture_default_str();
  addThreads(*command, options->threads);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
