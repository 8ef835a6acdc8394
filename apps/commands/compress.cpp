// SPDX-License-Identifier: BSD-3-Clause
// gaussmap compress MAP -o OUT --max-error E: removes detail where coarse cells are accurate enough.
#include "gaussmap/editing/compress.h"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include "commands/commands.h"
#include "commands/map_task.h"
#include "common/command.h"
#include "common/report.h"

namespace gaussmap::app {
namespace {

struct CompressCommand : MapTaskOptions {
  double max_error = 0.0;  // [m]
  CompressOptions compress;
};

const Help kCompressHelp = {
    "Remove detail below coarse cells that are accurate enough",
    "gaussmap compress street.gmap -o small.gmap --max-error 0.2",
    R"(Starts at the coarsest scale. All finer cells below a cell are removed if both conditions hold:
  - For each Gaussian of the cell, 95 % of its samples lie within --max-error of a mean of the finest scale.
  - Each mean of the finest scale below the cell lies within --max-error of an ellipsoid of the cell (95 % of the mass).
The other Gaussians stay unchanged. The result accepts no more scans and cannot be refined, so refine first.)"};

/// Returns scalesOf() with the counts of cells and Gaussians before the compression.
template <int D>
Json scalesWithCountsBefore(const GaussianMap<D>& map, const GaussianMap<D>& whole) {
  Json scales = scalesOf(map);
  for (int s = 0; s < map.scales(); ++s) {
    scales[static_cast<std::size_t>(s)]["cells_before"] = whole.cellCount(s);
    scales[static_cast<std::size_t>(s)]["gaussians_before"] = whole.gaussianCount(s);
  }
  return scales;
}

void print(const CompressCommand& command, const Json& scales, const MapTask& task) {
  std::printf("%s: max error %g m, %s of %s\n", command.output.path.c_str(), command.max_error,
              humanBytes(task.bytes()).c_str(), humanBytes(task.bytesBefore()).c_str());
  std::printf("%5s %10s %10s %10s %10s %10s\n", "scale", "cell [m]", "cells", "of", "Gaussians", "of");
  for (const Json& scale : scales)
    std::printf("%5d %10g %10zu %10zu %10zu %10zu\n", scale["scale"].get<int>(), scale["cell_side"].get<double>(),
                scale["cells"].get<std::size_t>(), scale["cells_before"].get<std::size_t>(),
                scale["gaussians"].get<std::size_t>(), scale["gaussians_before"].get<std::size_t>());
}

template <int D>
void run(CompressCommand command) {
  MapTask task(command);
  const GaussianMap<D> whole = task.load<D>();
  if (whole.isCompressed()) throw std::runtime_error(command.map + ": is already compressed; use the original map");
  command.compress.threads = command.threads;
  const GaussianMap<D> map = compress(whole, command.max_error, command.compress);
  task.addStep("compress", {{"max_error", command.max_error}, {"seed", command.compress.seed}});
  task.save(map);
  MapReport report;
  report.scales = scalesWithCountsBefore(map, whole);
  report.first = {{"max_error", command.max_error}};
  report.last = {{"bytes_before", task.bytesBefore()}};
  if (command.json)
    task.report(report);
  else
    print(command, report.scales, task);
}

}  // namespace

void addCompress(CLI::App& app) {
  auto options = std::make_shared<CompressCommand>();
  Command command(app, "compress", kCompressHelp);
  addMapToMap(command, *options);
  command
      .number("--max-error", options->max_error, 1e-9, 1e9,
              "maximum distance between a coarse cell and the finest scale [m]")
      .required()
      .hideDefault();
  command.seed(options->compress.seed, "seed of the samples").rare();
  addRunOptions(command, *options);
  command.onRun([options] { forMap(options->map, [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
