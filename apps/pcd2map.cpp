// SPDX-License-Identifier: BSD-3-Clause
// gaussmap pcd2map IN... -o OUT.gmap: scans in, map file out.
#include <cmath>
#include <iostream>

#include "budget.h"
#include "common.h"
#include "gaussmap/io/scan_list.h"
#include "gaussmap/mapping/build.h"
#include "online.h"

namespace gaussmap::app {
namespace {

struct Pcd2mapOptions {
  ScanInput input;
  Output output;
  MapOptions map;
  BudgetInput budget;
  OnlineInput online;
  bool json = false;
};

struct Built {
  GaussianMap<3> map;
  PointCounts counts;
};

void requirePoints(const PointCounts& counts, const std::vector<ScanSource>& scans) {
  if (counts.accepted > 0) return;
  throw std::runtime_error(nameOf(scans) + ": of " + std::to_string(counts.read) + " points none is usable: " +
                           std::to_string(counts.non_finite) + " are not finite, " + std::to_string(counts.at_sensor) +
                           " at range 0, " + std::to_string(counts.beyond_range) + " beyond --max-range");
}

Json jsonOf(const PointCounts& counts) {
  return {{"read", counts.read},
          {"accepted", counts.accepted},
          {"non_finite", counts.non_finite},
          {"at_sensor", counts.at_sensor},
          {"beyond_range", counts.beyond_range}};
}

Json historyOf(const std::vector<ScanSource>& scans, const PointCounts& counts) {
  return {{"command", "pcd2map"}, {"version", GAUSSMAP_VERSION}, {"scans", scans.size()}, {"points", jsonOf(counts)}};
}

Built buildAtOnce(const Pcd2mapOptions& options, const std::vector<ScanSource>& scans, const AccumulateOptions& reading,
                  MapMetadata& metadata) {
  ProgressBar bar;
  AccumulatedScans accumulated =
      accumulateScans(scans, reading, [&](const AccumulateProgress& progress) { bar.show(progress); });
  const PointCounts counts = accumulated.counts;
  requirePoints(counts, scans);
  GaussianMap<3> map = build<3>(accumulated.moments, options.map);
  accumulated.moments = MomentGrid<3>(options.map.resolution);  // its memory is not needed twice
  return {refineWithin(std::move(map), options.budget, metadata, historyOf(scans, counts)), counts};
}

Built buildOnline(const Pcd2mapOptions& options, const std::vector<ScanSource>& scans, const AccumulateOptions& reading,
                  MapMetadata& metadata) {
  OnlineResult result = mapOnline(scans, options.online, options.map, reading, options.budget);
  requirePoints(result.counts, scans);
  Json step = historyOf(scans, result.counts);
  step["online"] = true;
  step["budget"] = options.budget.budget;
  step["deleted"] = result.deleted;
  addHistory(metadata, step);
  return {std::move(result.map), result.counts};
}

void pcd2map(const Pcd2mapOptions& options) {
  try {
    const Grid<3> grid(options.map);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--") + error.what());
  }
  std::vector<std::filesystem::path> inputs = listScans({options.input.paths.begin(), options.input.paths.end()});
  if (!options.input.poses.empty()) inputs.push_back(options.input.poses);
  checkMapOutput(options.output, inputs);
  checkBudget(options.budget);
  checkOnline(options.online, options.budget, options.output, inputs);
  const double start = now();
  const int threads = options.budget.refine.threads;

  const std::vector<ScanSource> scans = findScans(options.input);
  MapMetadata metadata;
  const AccumulateOptions reading = accumulateOptions(options.input, options.map.resolution, threads);
  const Built built = options.online.on ? buildOnline(options, scans, reading, metadata)
                                        : buildAtOnce(options, scans, reading, metadata);
  const GaussianMap<3>& map = built.map;
  const PointCounts& counts = built.counts;
  saveMap<3>(map, options.output.path, metadata, {options.output.force, SaveOptions().compression, threads});

  const std::uintmax_t bytes = std::filesystem::file_size(options.output.path);
  const double seconds = now() - start;
  if (options.json) {
    printJson({{"map", options.output.path},
               {"scans", scans.size()},
               {"points", jsonOf(counts)},
               {"scales", scalesOf(map)},
               {"bytes", bytes},
               {"seconds", seconds}});
    return;
  }
  std::cout << options.output.path << ": " << scans.size() << (scans.size() == 1 ? " scan, " : " scans, ")
            << counts.accepted << " points";
  if (counts.accepted < counts.read)
    std::cout << " (left out: " << counts.non_finite << " not finite, " << counts.at_sensor << " at range 0, "
              << counts.beyond_range << " too far)";
  std::cout << ", Gaussians per scale";
  for (int s = 0; s < map.scales(); ++s) std::cout << (s ? " / " : " ") << map.gaussianCount(s);
  std::cout << ", " << humanBytes(bytes) << ", " << std::round(seconds * 100.0) / 100.0 << " s\n";
}

}  // namespace

void addPcd2map(CLI::App& app) {
  auto options = std::make_shared<Pcd2mapOptions>();
  CLI::App* command = app.add_subcommand("pcd2map", "Build a map from PCD scans");
  command->footer(
      "The pose of each scan is the VIEWPOINT of its file, unless --poses gives others or --frame map says that the\n"
      "points lie in the map frame already.\n"
      "Example: gaussmap pcd2map scans/*.pcd -o street.gmap --resolution 0.2 --budget 3");
  command->add_option("scans", options->input.paths, "PCD files, or directories of them (in natural order)")
      ->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  command->add_option("--resolution", options->map.resolution, "side of the finest cells [m]")->capture_default_str();
  command->add_option("--scales", options->map.scales, "number of scales")->capture_default_str();
  command->add_option("--ratio", options->map.ratio, "how many times wider the cells of the next scale are")
      ->capture_default_str();
  command->add_option("--noise", options->map.noise, "noise floor of every Gaussian [m]; 0: resolution / 20")
      ->capture_default_str();
  addBudgetOptions(*command, options->budget);
  addOnlineOptions(*command, options->online);
  addScanOptions(*command, options->input);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([options] { pcd2map(*options); });
}

}  // namespace gaussmap::app
