// SPDX-License-Identifier: BSD-3-Clause
// gaussmap merge A B... -o OUT: several maps into one.
#include "gaussmap/editing/merge_maps.h"

#include <cmath>
#include <iostream>

#include "common.h"
#include "gaussmap/core/error.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "motion.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct MergeCommand {
  std::vector<std::string> maps;
  Output output;
  MotionInput motion;
  bool resample = false, exact = false, json = false;
  MergeMapsOptions merge;
};

std::string gridOf(const GaussianMap<3>& map) {
  const MapOptions& options = map.options();
  return "cells of " + Json(options.resolution).dump() + " m, ratio " + std::to_string(options.ratio) + ", " +
         std::to_string(options.scales) + " scales, noise floor " + Json(options.noise).dump() + " m";
}

void requireExact(const GaussianMap<3>& map, const std::string& path, bool is_moved) {
  if (is_moved)
    throw UsageError("--exact: a map that is moved or resampled merges as Gaussians; leave one of the two out");
  if (!map.canGrow())
    throw FileError(path, std::string(map.isCompressed() ? "is compressed" : "holds Gaussians only") +
                              ": it has no exact moments to merge; leave out --exact to merge Gaussians");
}

void run(const MergeCommand& options) {
  const std::vector<std::filesystem::path> paths(options.maps.begin(), options.maps.end());
  std::vector<std::filesystem::path> inputs = paths;
  if (!options.motion.file.empty()) inputs.push_back(options.motion.file);
  checkMapOutput(options.output, inputs);
  if (paths.size() < 2) throw UsageError("merge takes two maps at least");
  const std::vector<RigidMotion<3>> motions = motionsOf(options.motion, {paths.begin() + 1, paths.end()});
  const double start = now();

  MapMetadata metadata;
  GaussianMap<3> merged = loadAnyMap(paths.front(), &metadata);
  if (options.exact) requireExact(merged, paths.front(), !motions.empty());
  for (std::size_t i = 1; i < paths.size(); ++i) {
    GaussianMap<3> next = loadAnyMap(paths[i]);
    if (options.exact) requireExact(next, paths[i], false);
    TransformOptions to;
    to.grid = merged.options();
    to.threads = options.merge.threads;
    if (next.options() == merged.options())
      to.grid.reset();
    else if (!options.resample)
      throw FileError(paths[i], "has " + gridOf(next) + "; " + options.maps.front() + " has " + gridOf(merged) +
                                    ": --resample sorts it into these cells");
    else if (options.exact)
      requireExact(next, paths[i], true);
    if (to.grid || !motions.empty())
      next = transformMap<3>(next, motions.empty() ? RigidMotion<3>() : motions[i - 1], to);
    merged = mergeMaps<3>(merged, next, options.merge);
  }

  metadata.erase("error_curves");  // of the first map alone
  Json step = {
      {"command", "merge"}, {"version", GAUSSMAP_VERSION}, {"maps", paths.size()}, {"exact", merged.canGrow()}};
  if (!options.motion.transforms.empty()) step["transforms"] = options.motion.transforms;
  if (!options.motion.file.empty()) step["transform_file"] = options.motion.file;
  if (!options.motion.covariance.empty()) step["pose_covariance"] = options.motion.covariance;
  addHistory(metadata, step);
  saveMap<3>(merged, options.output.path, metadata,
             {options.output.force, SaveOptions().compression, options.merge.threads});
  const std::uintmax_t bytes = std::filesystem::file_size(options.output.path);
  const double seconds = now() - start;
  const double points = merged.weight(merged.scales() - 1);
  if (options.json) {
    printJson({{"map", options.output.path},
               {"maps", paths.size()},
               {"points", points},
               {"exact", merged.canGrow()},
               {"scales", scalesOf(merged)},
               {"bytes", bytes},
               {"seconds", seconds}});
    return;
  }
  std::cout << options.output.path << ": " << paths.size() << " maps, " << static_cast<std::int64_t>(std::round(points))
            << " points, " << (merged.canGrow() ? "exact moments" : "Gaussians only") << ", Gaussians per scale "
            << perScale(merged) << ", " << humanBytes(bytes) << ", " << std::round(seconds * 100.0) / 100.0 << " s\n";
}

}  // namespace

void addMerge(CLI::App& app) {
  auto options = std::make_shared<MergeCommand>();
  CLI::App* command = app.add_subcommand("merge", "Several maps into one");
  command->footer(
      "Maps of parts of the scans give the finest scale of the map of all scans, to the last bit. Maps that were "
      "moved\n"
      "or made final hold no exact moments and merge as Gaussians; --exact refuses them. Poses are those of the "
      "second\n"
      "map's frame, the third's, ... in the first's.\n"
      "Example: gaussmap merge monday.gmap tuesday.gmap -o both.gmap --transform \"12.5 -3 0 0 0 0.7071 0.7071\"");
  command->add_option("maps", options->maps, "maps (.gmap, or PCD of Gaussians)")->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  addMotionOptions(*command, options->motion);
  command->add_flag("--resample", options->resample, "sort maps of other cells into those of the first map");
  command->add_flag("--exact", options->exact, "refuse what does not merge exactly");
  addThreads(*command, options->merge.threads);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
