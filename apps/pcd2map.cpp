// SPDX-License-Identifier: BSD-3-Clause
// gaussmap pcd2map IN... -o OUT.gmap: scans in, map file out; or --update MAP: scans into it.
#include <cmath>
#include <iostream>

#include "budget.h"
#include "common.h"
#include "gaussmap/io/gmap/build_map_file.h"
#include "gaussmap/io/gmap/map_history.h"
#include "gaussmap/io/scans/pcd_scans.h"
#include "gaussmap/mapping/build.h"
#include "online.h"
#include "scan_report.h"
#include "update.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct Pcd2mapOptions {
  ScanInput input;
  Output output;
  MapOptions map;
  BudgetInput budget;
  OnlineInput online;
  UpdateInput update;
  std::string max_memory;  // "": no limit
  bool json = false;
};

struct Built {
  GaussianMap<3> map;
  PointCounts counts;
};

/// What is said of a map that was written.
struct Written {
  PointCounts counts;
  Json scales = Json::array();
};

Built buildAtOnce(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
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

Built buildOnline(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading,
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

void checkMemory(const Pcd2mapOptions& options) {
  if (options.max_memory.empty()) return;
  if (options.online.on || options.budget.method != "agglomerate" || !options.budget.max_gaussians.empty() ||
      !options.budget.max_bytes.empty() || options.budget.max_error > 0.0)
    throw UsageError(
        "--max-memory: goes tile by tile, with --budget alone; --online, --method insert, --max-gaussians, --max-bytes "
        "and --max-error look at the whole map (gaussmap refine does so afterwards)");
  if (amountOf("--max-memory", options.max_memory, true) < kLeastBuildMemory)
    throw UsageError("--max-memory " + options.max_memory + ": at least " + std::to_string(kLeastBuildMemory) +
                     " bytes are needed");
}

Written buildWithinMemory(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading) {
  BuildMapFileOptions building;
  building.max_memory = amountOf("--max-memory", options.max_memory, true);
  building.refine = options.budget.refine;
  building.budget = PerCell{options.budget.budget};
  building.refine.merge_cost = mergeCost(options.budget);
  building.save = {options.output.force, SaveOptions().compression, options.budget.refine.threads};
  ProgressBar bar;
  const BuiltMapFile built = buildMapFile(
      scans, reading, options.map, options.output.path,
      [&](const PointCounts& counts) {
        requirePoints(counts, scans);
        MapMetadata metadata;
        // As refineWithin() writes it: the file is the same.
        const std::string details = detailsOf(options.budget, historyOf(scans, counts));
        recordStep(metadata, refineStep(building.budget, building.refine, details));
        return metadata;
      },
      building, [&](const AccumulateProgress& progress) { bar.show(progress); });
  Written written{built.counts, Json::array()};
  const Grid<3> grid(options.map);
  for (int s = 0; s < grid.scales(); ++s)
    written.scales.push_back({{"scale", s},
                              {"cell_side", grid.side(s)},
                              {"cells", built.cells[static_cast<std::size_t>(s)]},
                              {"gaussians", built.gaussians[static_cast<std::size_t>(s)]},
                              {"weight", static_cast<double>(built.counts.accepted)}});
  return written;
}

Written buildInMemory(const Pcd2mapOptions& options, const Scans& scans, const AccumulateOptions& reading) {
  MapMetadata metadata;
  const Built built = options.online.on ? buildOnline(options, scans, reading, metadata)
                                        : buildAtOnce(options, scans, reading, metadata);
  saveMap<3>(built.map, options.output.path, metadata,
             {options.output.force, SaveOptions().compression, options.budget.refine.threads});
  return {built.counts, scalesOf(built.map)};
}

void pcd2map(const Pcd2mapOptions& options) {
  if (!options.update.map.empty()) return updateFromScans(options.update, options.input, options.budget, options.json);
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
  checkMemory(options);
  const double start = now();

  const PcdScans scans = openScans(options.input);
  const AccumulateOptions reading =
      accumulateOptions(options.input, options.map.resolution, options.budget.refine.threads);
  const Written written =
      options.max_memory.empty() ? buildInMemory(options, scans, reading) : buildWithinMemory(options, scans, reading);

  const std::uintmax_t bytes = std::filesystem::file_size(options.output.path);
  const double seconds = now() - start;
  if (options.json) {
    printJson({{"map", options.output.path},
               {"scans", scans.size()},
               {"points", countsJson(written.counts)},
               {"scales", written.scales},
               {"bytes", bytes},
               {"seconds", seconds}});
    return;
  }
  std::vector<std::size_t> gaussians;
  for (const Json& scale : written.scales) gaussians.push_back(scale["gaussians"].get<std::size_t>());
  std::cout << options.output.path << ": " << summaryOf(scans, written.counts) << ", Gaussians per scale "
            << perScale(gaussians) << ", " << humanBytes(bytes) << ", " << std::round(seconds * 100.0) / 100.0
            << " s\n";
}

}  // namespace

void addPcd2map(CLI::App& app) {
  auto options = std::make_shared<Pcd2mapOptions>();
  CLI::App* command = app.add_subcommand("pcd2map", "Build a map from PCD scans");
  command->footer(
      "The pose of each scan is the VIEWPOINT of its file, unless --poses gives others or --frame map says that the\n"
      "points lie in the map frame already.\n"
      "--update adds scans to a map file and writes only the tiles that change: its finest scale is then that of a "
      "map\n"
      "built of all scans at once. Coarse cells with new points are made anew, within the budget of the whole scale:\n"
      "--budget, else the one that the map was made with, else as many Gaussians a cell as it has. Cells of a map "
      "with\n"
      "occupancy keep it, new ones are certain. The old map stays until the new one is complete.\n"
      "Example: gaussmap pcd2map scans/*.pcd -o street.gmap --resolution 0.2 --budget 3");
  command->add_option("scans", options->input.paths, "PCD files, or directories of them (in natural order)")
      ->required();
  addOutput(*command, options->output, "map file to write (.gmap)");
  CLI::Option* output = command->get_option("--output")->required(false);
  CLI::Option* update = command->add_option("--update", options->update.map, "map file to add the scans to (.gmap)");
  command->add_option("--resolution", options->map.resolution, "side of the finest cells [m]")->capture_default_str();
  command->add_option("--scales", options->map.scales, "number of scales")->capture_default_str();
  command->add_option("--ratio", options->map.ratio, "how many times wider the cells of the next scale are")
      ->capture_default_str();
  command->add_option("--noise", options->map.noise, "noise floor of every Gaussian [m]; 0: resolution / 20")
      ->capture_default_str();
  addBudgetOptions(*command, options->budget);
  addOnlineOptions(*command, options->online);
  addScanOptions(*command, options->input);
  command->add_option("--max-memory", options->max_memory,
                      "build within so much memory (with k, M or G behind it), tile by tile through a file without a "
                      "name beside the map; the map is the same, without error curves");
  command->add_flag("!--no-curves", options->budget.curves,
                    "do not measure what other budgets would give (gaussmap info); takes less time");
  command->add_flag("--json", options->json, "print the result for machines");
  for (const char* const other : {"--output", "--force", "--resolution", "--scales", "--ratio", "--noise", "--online",
                                  "--max-gaussians", "--max-bytes", "--max-error", "--method", "--max-memory"})
    update->excludes(command->get_option(other));
  command->callback([options, command, output, update] {
    if (output->count() + update->count() == 0) throw UsageError("--output is required (or --update MAP)");
    if (command->count("--budget") > 0) options->update.budget = options->budget.budget;
    pcd2map(*options);
  });
}

}  // namespace gaussmap::app
