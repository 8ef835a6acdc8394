// SPDX-License-Identifier: BSD-3-Clause
// gaussmap finish MAP -o OUT: writes a small, final map that accepts no more scans.
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "commands/commands.h"
#include "commands/map_task.h"
#include "common/command.h"
#include "common/report.h"

namespace gaussmap::app {
namespace {

struct FinishCommand : MapTaskOptions {
  int finest_scale = 0;
  int compression = 15;  // zstd level; high, because a final map is written once and read often
};

const Help kFinishHelp = {"Write a small, final map that accepts no more scans",
                          "gaussmap finish street.gmap -o robot.gmap",
                          R"(Drops the moments, which are needed only to add scans, and rounds the other numbers:
  - means by at most 1/16 standard deviation along each axis (with the other coordinates fixed),
  - standard deviations by at most 5 % in every direction,
  - weights and log-odds by at most 1/32.
Covariances stay positive definite. A final map can no longer be merged exactly, so keep the original map.)"};

template <int D>
void run(const FinishCommand& command) {
  MapTask task(command);
  GaussianMap<D> map = task.load<D>();
  if (task.metadata.count(kFinalEntry) > 0)
    throw std::runtime_error(command.map + ": is already final; use the original map");
  checkScale("--finest-scale", command.finest_scale, map.scales());
  map = finish<D>(map, command.finest_scale);
  Json step = historyStep("finish");
  if (command.finest_scale > 0) {
    step["finest_scale"] = command.finest_scale;
    task.metadata.erase("error_curves");  // the curves are relative to a scale that is no longer in the map
  }
  addHistory(task.metadata, step);
  SaveOptions saving;
  saving.compression = command.compression;
  saving.precision = Precision::Finished;
  task.save(map, saving);

  const std::uintmax_t bytes = task.bytes(), before = task.bytesBefore();
  std::size_t gaussians = 0;
  for (int s = 0; s < map.scales(); ++s) gaussians += map.gaussianCount(s);
  const double per_gaussian = gaussians > 0 ? static_cast<double>(bytes) / static_cast<double>(gaussians) : 0.0;
  const std::string error = loadMetadata(command.output.path).at(kFinalEntry);
  if (command.json) {
    MapReport report;
    report.scales = scalesOf(map);
    report.last = {{"bytes_before", before}, {"bytes_per_gaussian", per_gaussian}, {"error", error}};
    return task.report(report);
  }
  std::printf("%s: %zu Gaussians, %s of %s, %.1f bytes per Gaussian; %s\n", command.output.path.c_str(), gaussians,
              humanBytes(bytes).c_str(), humanBytes(before).c_str(), per_gaussian, error.c_str());
}

}  // namespace

void addFinish(CLI::App& app) {
  auto options = std::make_shared<FinishCommand>();
  Command command(app, "finish", kFinishHelp);
  addMapToMap(command, *options);
  command.number("--finest-scale", options->finest_scale, 0, 63, "leave out the scales that are finer than this one");
  command.number("--compression", options->compression, 1, 19,
                 "zstd level; a higher level gives a smaller file, but takes longer");
  addRunOptions(command, *options);
  command.onRun([options] { forMap(options->map, [&](auto dimensions) { run<dimensions()>(*options); }); });
}

}  // namespace gaussmap::app
