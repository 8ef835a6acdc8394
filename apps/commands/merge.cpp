// SPDX-License-Identifier: BSD-3-Clause
// gaussmap merge A B... -o OUT: merges several maps into one.
#include "gaussmap/editing/merge_maps.h"

#include <cmath>
#include <map>
#include <memory>

#include "commands/budget.h"
#include "commands/commands.h"
#include "commands/map_task.h"
#include "commands/motion.h"
#include "common/command.h"
#include "common/report.h"
#include "gaussmap/core/error.h"
#include "gaussmap/editing/transform_map.h"

namespace gaussmap::app {
namespace {

struct MergeCommand : MapTaskOptions {
  std::vector<std::string> maps;
  MotionInput motion;
  bool resample = false, exact = false;
  MergeMapsOptions merging;
  bool as_in_paper = false;
};

const std::map<std::string, MergeMethod> kMergeMethods = {{"finer-scales", MergeMethod::FinerScales},
                                                          {"clusters", MergeMethod::Clusters}};

const Help kMergeHelp = {
    "Merge several maps into one",
    R"(gaussmap merge monday.gmap tuesday.gmap -o both.gmap --transform "12.5 -3 0 0 0 0.7071 0.7071")",
    R"(If all maps have exact moments, the finest scale of the result is the same as in one map of all their scans.
Final maps, and maps that are or were moved or resampled, have no exact moments. If there is such a map, the result
holds Gaussians only; --exact refuses it. Compressed maps need --method clusters. The first map does not move. For each
of the others, in the same order, give --transform with its pose in the frame of the first map.

--as-in-paper: --method clusters --cost kl --smooth, as in Yguel et al. 2009. In every coarse cell that both maps have,
the pair of clusters with the smallest KL divergence is merged, again and again. If the cell has 3 clusters in one map
and 5 in the other, 5 are left. Then the clustering runs once. Options that are also given override these settings.)"};

std::string gridOf(const MapOptions& options) {
  return "cells of " + Json(options.resolution).dump() + " m, ratio " + std::to_string(options.ratio) + ", " +
         std::to_string(options.scales) + " scales, noise floor " + Json(options.noise).dump() + " m";
}

template <int D>
void requireExact(const GaussianMap<D>& map, const std::string& path, bool is_moved) {
  if (is_moved)
    throw UsageError("--exact: a moved or resampled map has no exact moments; leave out --exact to merge Gaussians");
  if (!map.acceptsScans())
    throw FileError(path, std::string(map.isCompressed() ? "is compressed" : "holds Gaussians only") +
                              ", so it has no exact moments; leave out --exact to merge Gaussians");
}

/// Warns if two maps that are not moved have different coordinate reference systems.
void warnOfOtherSystem(const MapMetadata& first, const MapMetadata& other, const std::string& path) {
  const auto a = first.find(kCoordinateSystemEntry), b = other.find(kCoordinateSystemEntry);
  if (a != first.end() && b != other.end() && a->second != b->second)
    warn(path + ": the coordinate reference system differs from that of the first map, which the result keeps");
}

/// Loads the maps one after the other, transforms each into the frame and grid of the first map, and merges it.
template <int D>
GaussianMap<D> merged(const MergeCommand& command, const Motions& motions, MapTask& task) {
  const std::vector<std::string>& paths = command.maps;
  GaussianMap<D> merged = task.load<D>(paths.front());
  if (command.exact) requireExact(merged, paths.front(), !motions.poses.empty());
  for (std::size_t i = 1; i < paths.size(); ++i) {
    MapMetadata metadata;
    GaussianMap<D> next = loadMap<D>(paths[i], &metadata);
    if (motions.poses.empty()) warnOfOtherSystem(task.metadata, metadata, paths[i]);
    if (command.exact) requireExact(next, paths[i], false);
    TransformOptions to;
    to.grid = merged.options();
    to.covariance = motions.covariance;
    to.threads = command.threads;
    if (next.options() == merged.options())
      to.grid.reset();
    else if (!command.resample)
      throw FileError(paths[i], "has " + gridOf(next.options()) + "; " + paths.front() + " has " +
                                    gridOf(merged.options()) + "; use --resample to convert it to this grid");
    else if (command.exact)
      requireExact(next, paths[i], true);
    if (to.grid || !motions.poses.empty())
      next = transformMap<D>(next, motions.poses.empty() ? Pose() : motions.poses[i - 1], to);
    MergeMapsOptions options = command.merging;
    options.threads = command.threads;
    merged = mergeMaps<D>(merged, next, options);
  }
  return merged;
}

template <int D>
void run(const MergeCommand& command) {
  std::vector<std::filesystem::path> inputs(command.maps.begin(), command.maps.end());
  const std::vector<std::filesystem::path> to_move(inputs.begin() + 1, inputs.end());
  const std::size_t count = inputs.size();
  if (!command.motion.file.empty()) inputs.emplace_back(command.motion.file);
  MapTask task(command, inputs);
  if (count < 2) throw UsageError("merge needs at least two maps");
  const GaussianMap<D> map = merged<D>(command, motionsOf(command.motion, to_move), task);

  Json step = {{"maps", count}, {"exact", map.acceptsScans()}};
  if (command.as_in_paper) step["as_in_paper"] = true;
  // Not "method", by which pcd2map --update finds the last refinement.
  if (command.merging.method == MergeMethod::Clusters) step["merge_method"] = "clusters";
  if (command.merging.merge_cost != MergeMapsOptions().merge_cost) step["cost"] = wordOf(command.merging.merge_cost);
  if (command.merging.smooth) step["smooth"] = true;
  if (!command.motion.transforms.empty()) step["transforms"] = command.motion.transforms;
  if (!command.motion.file.empty()) step["transform_file"] = command.motion.file;
  if (!command.motion.covariance.empty()) step["pose_covariance"] = command.motion.covariance;
  task.addStep("merge", step);
  task.save(map);
  const double points = map.weight(map.scales() - 1);
  MapReport report;
  report.before = std::to_string(count) + " maps, " + std::to_string(std::llround(points)) + " points, " +
                  (map.acceptsScans() ? "exact moments, " : "Gaussians only, ");
  report.counts = perScale(map);
  report.scales = scalesOf(map);
  report.first = {{"maps", count}, {"points", points}, {"exact", map.acceptsScans()}};
  report.tell_time = true;
  task.report(report);
}

}  // namespace

void addMerge(CLI::App& app) {
  auto options = std::make_shared<MergeCommand>();
  Command command(app, "merge", kMergeHelp);
  command.texts("maps", options->maps, "maps (.gmap, or PCD of Gaussians)").required();
  addMapOutput(command, *options);
  addMotionOptions(command, options->motion);
  command.flag("--resample", options->resample,
               "convert maps with other cells, ratio, scales or noise floor to those of the first map");
  command.flag("--exact", options->exact, "refuse maps that cannot be merged exactly");
  command.preset(
      "--as-in-paper",
      [options] {
        options->merging = MergeMapsOptions::yguel2009();
        options->as_in_paper = true;
      },
      "use the settings of Yguel et al. 2009");
  command
      .choiceOf(
          "--method", options->merging.method, kMergeMethods,
          R"(source of the coarse scales: the finer scale, with the number of clusters fixed per scale (finer-scales),
                or the clusters of both maps, with the number fixed per cell, as in the paper (clusters))")
      .rare();
  command
      .choiceOf("--cost", options->merging.merge_cost, mergeCosts(),
                R"(which pair to merge first: the one that adds least volume, that loses least likelihood (runnalls),
                or that has the smallest KL divergence, as in the paper (kl))")
      .rare();
  addSmooth(command, options->merging.smooth);
  addRunOptions(command, *options);
  command.files({"maps"}, {".gmap", ".pcd"});
  command.onRun([options] { forMap(options->maps.front(), [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
