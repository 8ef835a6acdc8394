// SPDX-License-Identifier: BSD-3-Clause
// gaussmap compress MAP -o OUT --max-error E: removes detail where coarse cells are accurate enough.
#include "gaussmap/editing/compress.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "commands/commands.h"
#include "commands/map_task.h"
#include "common/command.h"
#include "common/report.h"

namespace gaussmap::app {
namespace {

struct CompressCommand : MapTaskOptions {
  std::optional<double> max_error;       // [m]
  std::optional<double> max_cell_error;  // eq. (6), no unit
  bool as_in_paper = false;
  CompressOptions compress;
};

const Help kCompressHelp = {
    "Remove detail below coarse cells that are accurate enough",
    "gaussmap compress street.gmap -o small.gmap --max-error 0.2",
    R"(Starts at the coarsest scale. All finer cells below a cell are removed if both conditions hold:
  - For each Gaussian of the cell, 95 % of its samples lie within --max-error of a mean of the finest scale.
  - Each mean of the finest scale below the cell lies within --max-error of an ellipsoid of the cell (95 % of the mass).
With --max-cell-error instead, all finer cells below a cell are removed if the error of this cell, and of every coarse
cell below it, is at most this value. The error is the mean squared Mahalanobis distance from a Gaussian of the next
finer scale to the nearest Gaussian of the cell, Yguel et al. 2009, eq. (6). It has no unit. For a flat floor with one
Gaussian per cell, it is in the hundreds. --as-in-paper: --learning-factor, and --max-cell-error is needed.

The other Gaussians stay unchanged. The result accepts no more scans and cannot be refined, so refine first.)"};

std::string limitText(const CompressCommand& command) {
  std::ostringstream text;
  if (command.max_error)
    text << "error " << *command.max_error << " m";
  else
    text << "cell error " << *command.max_cell_error;
  return text.str();
}

void checkLimits(const CompressCommand& command) {
  if (command.as_in_paper && command.max_error)
    throw UsageError(
        "--max-error: not with --as-in-paper, which limits the error of eq. (6) and not a distance; use "
        "--max-cell-error");
  if (!command.max_error && !command.max_cell_error)
    throw UsageError(command.as_in_paper ? "--as-in-paper: give the limit with --max-cell-error"
                                         : "compress needs --max-error or --max-cell-error");
  if (command.compress.learning_factor && command.max_error)
    throw UsageError("--learning-factor: only with --max-cell-error");
}

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
  std::printf("%s: max %s, %s of %s\n", command.output.path.c_str(), limitText(command).c_str(),
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
  checkLimits(command);
  const GaussianMap<D> whole = task.load<D>();
  if (whole.isCompressed()) throw std::runtime_error(command.map + ": is already compressed; use the original map");
  command.compress.threads = command.threads;
  command.compress.by = command.max_error ? CompressBy::Distance : CompressBy::CellError;
  const GaussianMap<D> map =
      compress(whole, command.max_error ? *command.max_error : *command.max_cell_error, command.compress);
  const Json limit =
      command.max_error ? Json{{"max_error", *command.max_error}} : Json{{"max_cell_error", *command.max_cell_error}};
  Json step = limit;
  if (command.max_error) step["seed"] = command.compress.seed;
  if (command.as_in_paper) step["as_in_paper"] = true;
  if (command.compress.learning_factor) step["learning_factor"] = true;
  task.addStep("compress", step);
  task.save(map);
  MapReport report;
  report.scales = scalesWithCountsBefore(map, whole);
  report.first = limit;
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
  command.preset(
      "--as-in-paper",
      [options] {
        options->compress = CompressOptions::yguel2009();
        options->as_in_paper = true;
      },
      "use the settings of Yguel et al. 2009; needs --max-cell-error");
  command.number("--max-error", options->max_error, 1e-9, 1e9,
                 "maximum distance between a coarse cell and the finest scale [m]");
  command
      .number("--max-cell-error", options->max_cell_error, 1e-9, 1e30,
              "maximum error of a coarse cell, Yguel et al. 2009, eq. (6); no unit")
      .rare();
  command.exclusive({"--max-error", "--max-cell-error"});
  command
      .flag("--learning-factor", options->compress.learning_factor,
            "weight finer Gaussians by 1 - learning rate in the error of a cell, eq. (6), as in the paper")
      .rare();
  command.seed(options->compress.seed, "seed of the samples").rare();
  addRunOptions(command, *options);
  command.onRun([options] { forMap(options->map, [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
