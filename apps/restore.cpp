// SPDX-License-Identifier: BSD-3-Clause
// gaussmap restore MAP REMOVED -o OUT: brings deleted clusters back.
#include <algorithm>
#include <iostream>
#include <optional>
#include <vector>

#include "common.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "io/pcd/removed_pcd.h"
#include "map/inherit_occupancy.h"

namespace gaussmap::app {
using namespace detail;

namespace {

constexpr std::int64_t kMostPoints = (std::int64_t{1} << 33) - 1;  // of a cell, see CellMoments

struct RestoreCommand {
  std::string map, removed;
  Output output;
  std::vector<double> box;  // x0 y0 z0 x1 y1 z1 [m], empty: everywhere
  int threads = 0;
  bool json = false;
};

bool isInside(const Eigen::Vector3d& point, const std::vector<double>& box) {
  for (std::size_t axis = 0; axis < 3 && !box.empty(); ++axis) {
    const double coordinate = point[Eigen::Index(axis)];
    if (coordinate < box[axis] || coordinate > box[axis + 3]) return false;
  }
  return true;
}

/// Throws FileError unless the sums of a finest cluster belong to its cell in such a grid.
void checkSums(const RemovedCluster<3>& one, const Grid<3>& grid, const std::string& path) {
  const std::string name = "the cluster of cell " + toString<3>(one.key);
  if (one.moments.count == 0)
    throw FileError(path, name + " has no exact sums: it was deleted under --learning-rate occupancy");
  const double side = grid.side(0);
  const Eigen::Vector3d from_sums = grid.centre(one.key, 0) + one.moments.mean(side);
  // Far coordinates are rounded; in a grid of another resolution the cell is somewhere else.
  if (!((from_sums - one.gaussian.mean).norm() <= 1e-3 * side) || grid.keyOf(from_sums) != one.key)
    throw FileError(path, name + " does not lie there in cells of " + Json(side).dump() +
                              " m: it was deleted from a map of another resolution");
}

/// The cells of the map and the clusters in the box. Counts the latter.
MomentGrid<3> sumsOf(const GaussianMap<3>& map, const std::vector<RemovedCluster<3>>& removed,
                     const RestoreCommand& options, std::size_t& clusters) {
  MomentGrid<3> sums(map.grid().side(0));
  std::int64_t most = 0;
  for (std::size_t i = 0; i < map.cellCount(0); ++i) {
    sums.add(map.scale(0).keys[i], map.scale(0).moments[i]);
    most = std::max(most, map.scale(0).moments[i].count);
  }
  for (const RemovedCluster<3>& one : removed) {
    if (one.scale > 0) continue;  // made anew
    checkSums(one, map.grid(), options.removed);
    if (!isInside(one.gaussian.mean, options.box)) continue;
    most += one.moments.count;
    if (most > kMostPoints) throw FileError(options.removed, "too many points for one cell");
    sums.add(one.key, one.moments);
    ++clusters;
  }
  return sums;
}

/// Log-odds of the finest cells: what was brought back is certain, whoever asks for it knows that it is there.
std::vector<float> occupancyAfter(const GaussianMap<3>& map, const GaussianMap<3>& old) {
  std::vector<float> log_odds;
  for (std::size_t cell = 0; cell < map.cellCount(0); ++cell) {
    const std::optional<std::size_t> before = old.find(map.scale(0).keys[cell], 0);
    const bool is_as_before = before && old.scale(0).moments[*before] == map.scale(0).moments[cell];
    log_odds.push_back(is_as_before ? old.logOdds(*before, 0) : kMaxOccupancy);
  }
  return log_odds;
}

/// The coarse scales made anew, as large as they were, but one Gaussian a cell at least.
GaussianMap<3> rebuilt(const MomentGrid<3>& sums, const GaussianMap<3>& old, int threads) {
  GaussianMap<3> map = build<3>(sums, old.options());
  if (old.hasOccupancy()) map = withOccupancy<3>(map, occupancyAfter(map, old));
  RefineOptions options;
  MaxGaussians budget;
  options.threads = threads;
  bool is_unrefined = true;
  for (int s = 1; s < map.scales(); ++s) {
    budget.by_scale[s] = std::max(old.gaussianCount(s), map.cellCount(s));
    is_unrefined = is_unrefined && budget.by_scale[s] == map.cellCount(s);
  }
  return is_unrefined ? map : refine<3>(std::move(map), budget, options).map;
}

void run(const RestoreCommand& options) {
  for (std::size_t axis = 0; axis < 3 && !options.box.empty(); ++axis)
    if (options.box[axis] > options.box[axis + 3])
      throw UsageError("--box: takes the low corner first: x0 y0 z0 x1 y1 z1");
  checkMapOutput(options.output, {options.map, options.removed});
  const double start = now();
  MapMetadata metadata;
  const GaussianMap<3> old = loadAnyMap(options.map, &metadata);
  if (!old.canGrow())
    throw FileError(options.map, std::string(old.isCompressed() ? "is compressed" : "holds Gaussians only") +
                                     ": nothing can be brought back into it exactly");
  const std::vector<RemovedCluster<3>> removed = readRemoved(options.removed);
  std::size_t clusters = 0;
  const MomentGrid<3> sums = sumsOf(old, removed, options, clusters);
  const auto points = sums.pointCount() - static_cast<std::int64_t>(old.weight(0));
  const GaussianMap<3> map = rebuilt(sums, old, options.threads);

  metadata.erase("error_curves");  // of the map as it was
  Json step = {{"command", "restore"}, {"version", GAUSSMAP_VERSION}, {"clusters", clusters}, {"points", points}};
  if (!options.box.empty()) step["box"] = options.box;
  addHistory(metadata, step);
  saveMap<3>(map, options.output.path, metadata, {options.output.force, SaveOptions().compression, options.threads});
  const std::uintmax_t bytes = std::filesystem::file_size(options.output.path);
  if (options.json) {
    printJson({{"map", options.output.path},
               {"clusters", clusters},
               {"points", points},
               {"scales", scalesOf(map)},
               {"bytes", bytes},
               {"seconds", now() - start}});
    return;
  }
  std::cout << options.output.path << ": " << clusters << (clusters == 1 ? " cluster" : " clusters") << " of " << points
            << " points brought back, Gaussians per scale " << perScale(map) << ", " << humanBytes(bytes) << '\n';
}

}  // namespace

void addRestore(CLI::App& app) {
  auto options = std::make_shared<RestoreCommand>();
  CLI::App* command = app.add_subcommand("restore", "Bring back what pcd2map --online has deleted");
  command->footer(
      "The finest scale is exactly what it was before, and took in since; the coarse scales are made anew, with as\n"
      "many Gaussians as they have. What is brought back twice counts twice.\n"
      "Example: gaussmap restore street.gmap removed.pcd -o whole.gmap --box -5 0 -1 5 20 3");
  command->add_option("map", options->map, "map (.gmap)")->required();
  command->add_option("removed", options->removed, "deleted clusters, of pcd2map --online --removed (.pcd)")
      ->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  command->add_option("--box", options->box, "only clusters whose mean lies in this box: x0 y0 z0 x1 y1 z1 [m]")
      ->expected(6)
      ->check(numberBetween(-1e12, 1e12));
  addThreads(*command, options->threads);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
