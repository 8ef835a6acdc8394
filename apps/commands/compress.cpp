// SPDX-License-Identifier: BSD-3-Clause
// gaussmap compress MAP -o OUT --max-error E: detail only where it is needed.
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

const Help kCompressHelp = {"Remove detail below coarse cells that are accurate enough",
                            "gaussmap compress street.gmap -o small.gmap --max-error 0.2",
                            R"(Starts at the coarsest scale. Everything finer below a cell is removed if
  - 95 % of the samples of each of its Gaussians lie within --max-error of the means of the finest scale, and
  - each of these means below the cell lies within --max-error of an ellipsoid (95 % of the mass) of the cell.
All other Gaussians stay unchanged. The result accepts no more scans and cannot be refined: refine first.)"};

/// Cells and Gaussians of every scale, also as they were before.
Json scalesWithCountsBefore(const GaussianMap<3>& map, const GaussianMap<3>& whole) {
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

void run(CompressCommand command) {
  MapTask task(command);
  const GaussianMap<3> whole = task.load();
  if (whole.isCompressed())
    throw std::runtime_error(command.map + ": is compressed already, compress the map that it was made from");
  command.compress.threads = command.threads;
  const GaussianMap<3> map = compress(whole, command.max_error, command.compress);
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
  command.number("--max-error", options->max_error, 1e-9, 1e9, "how far a coarse cell may be from the finest scale [m]")
      .required()
      .hideDefault();
  command.seed(options->compress.seed, "seed of the samples").rare();
  addRunOptions(command, *options);
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
