// SPDX-License-Identifier: BSD-3-Clause
// gaussmap restore MAP REMOVED -o OUT: restores deleted clusters.
#include <memory>
#include <stdexcept>

#include "commands/commands.h"
#include "commands/map_task.h"
#include "common/command.h"
#include "common/report.h"
#include "editing/restore_clusters.h"
#include "gaussmap/core/error.h"
#include "io/pcd/removed_pcd.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct RestoreCommand : MapTaskOptions {
  std::string removed;
  std::vector<double> box;  // x0 y0 z0 x1 y1 z1 [m], empty: everywhere
};

const Help kRestoreHelp = {
    "Restore clusters (Gaussians) that pcd2map --online has deleted from a map",
    "gaussmap restore street.gmap removed.pcd -o whole.gmap --box -5 0 -1 5 20 3",
    R"(The finest scale becomes exactly what it would be if the clusters had not been deleted. The coarse scales are
rebuilt with as many Gaussians as before, but at least one per cell. Do not restore a cluster twice: its points
would count twice.)"};

template <int D>
std::function<bool(const Vector<D>&)> region(const std::vector<double>& box) {
  if (box.empty()) return [](const Vector<D>&) { return true; };
  if (box.size() != 2 * D)
    throw UsageError(D == 2 ? "--box: a planar map has no heights; give x0 y0 x1 y1"
                            : "--box: " + std::to_string(box.size()) + " numbers found, expected x0 y0 z0 x1 y1 z1");
  const Eigen::Map<const Vector<D>> first(box.data()), second(box.data() + D);
  const Vector<D> low = first, high = second;
  if ((low.array() > high.array()).any())
    throw UsageError(std::string("--box: no coordinate of the first corner may be above that of the second corner: ") +
                     (D == 2 ? "x0 y0 x1 y1" : "x0 y0 z0 x1 y1 z1"));
  return
      [low, high](const Vector<D>& p) { return !(p.array() < low.array()).any() && !(p.array() > high.array()).any(); };
}

template <int D>
void run(const RestoreCommand& command) {
  const auto isInside = region<D>(command.box);
  MapTask task(command, {command.map, command.removed});
  const GaussianMap<D> old = task.load<D>();
  if (!old.acceptsScans())
    throw FileError(command.map, std::string(old.isCompressed() ? "is compressed" : "holds Gaussians only") +
                                     ", so clusters cannot be restored exactly; use a map with moments");
  const std::vector<RemovedCluster<D>> removed = readRemoved<D>(command.removed);
  RestoredMap<D> restored;
  try {
    restored = restoreClusters<D>(old, removed, isInside, command.threads);
  } catch (const std::invalid_argument& error) {
    throw FileError(command.removed, error.what());
  }

  const Json counts = {{"clusters", restored.clusters}, {"points", restored.points}};
  Json step = counts;
  if (!command.box.empty()) step["box"] = command.box;
  task.addStep("restore", step);
  task.save(restored.map);
  MapReport report;
  report.before = std::to_string(restored.clusters) + (restored.clusters == 1 ? " cluster" : " clusters") + " of " +
                  std::to_string(restored.points) + " points restored, ";
  report.counts = perScale(restored.map);
  report.scales = scalesOf(restored.map);
  report.first = counts;
  task.report(report);
}

}  // namespace

void addRestore(CLI::App& app) {
  auto options = std::make_shared<RestoreCommand>();
  Command command(app, "restore", kRestoreHelp);
  command.text("map", options->map, "map (.gmap)").required();
  command.text("removed", options->removed, "deleted clusters, written by pcd2map --online --removed (.pcd)")
      .required();
  addMapOutput(command, *options);
  command.numbers(
      "--box", options->box, 4, 6, -1e12, 1e12,
      "restore only clusters whose mean is in this box: x0 y0 z0 x1 y1 z1, or x0 y0 x1 y1 for a planar map [m]");
  addRunOptions(command, *options);
  command.files({"map"}, {".gmap"});
  command.files({"removed"}, {".pcd"});
  command.onRun([options] { forMap(options->map, [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
