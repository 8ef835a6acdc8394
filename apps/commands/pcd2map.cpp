// SPDX-License-Identifier: BSD-3-Clause
// gaussmap pcd2map IN... -o OUT.gmap: builds a map from scans. With --update MAP: adds scans to a map.
#include "commands/pcd2map/pcd2map.h"

#include <memory>

#include "commands/commands.h"
#include "commands/dropped_fields.h"
#include "commands/pcd2map/scan_report.h"
#include "common/command.h"
#include "common/report.h"
#include "gaussmap/io/gmap/map_file.h"
#include "gaussmap/io/scans/file_scans.h"

namespace gaussmap::app {
namespace {

const Help kPcd2mapHelp = {
    "Build a map from scans", "gaussmap pcd2map scans/*.pcd -o street.gmap --resolution 0.2 --budget 3",
    R"(Reads PCD, PLY, LAS, LAZ, E57, .bin (KITTI, nuScenes), text, PTS, PTX, logs of CARMEN, and recordings of ROS (MCAP,
rosbag2, bags of ROS 1). The pose of a scan is that in its file: VIEWPOINT, the pose in an E57 or PTX file or a log, tf
or odometry of a recording. --poses replaces it: TUM (t x y z qx qy qz qw), KITTI (12 numbers), CSV with a header line,
and others. Poses are matched to scans by name, time or number, else by order. gaussmap scans shows the result. With
--frame map, the points are already in the map frame. gaussmap assumes the same for LAS and LAZ files, unless --poses is
given.

--update adds scans to a map file and writes only the tiles that change. The finest scale then equals that of a map
of all scans. Coarse cells with new points are rebuilt within --budget (default: the budget of the last refinement,
or else the present number of Gaussians per cell). Cells keep their occupancy, and new cells count as occupied.
Readers see either the old or the new file.

--online adds one scan after the other, marks cells that the laser sees through as free, and deletes what has moved.
With --as-in-paper, cells, learning, occupancy, deletion and refinement are those of Yguel et al. 2009. Options that are
also given override these settings. The paper prints no budget, so --budget keeps its default.

--planar builds a map in the plane z = 0 from scans of a planar laser: files of any kind, logs of CARMEN, LaserScan
messages of recordings. 3-D scans need --slice: points between two heights of the map frame. With --online, only the
nearest of these points in every direction is used. --update reads from the file whether the map is planar.)"};

template <int D>
void run(const Pcd2mapOptions& options) {
  try {
    const Grid<D> grid(options.map);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--") + error.what());
  }
  std::vector<std::filesystem::path> inputs = listScans({options.input.paths.begin(), options.input.paths.end()});
  if (!options.input.poses.empty()) inputs.emplace_back(options.input.poses);
  if (!options.input.extrinsic.empty()) inputs.emplace_back(options.input.extrinsic);
  MapTask task({"", options.output, options.budget.refine.threads, options.json}, inputs);
  checkBudget(options.budget);
  checkOnline(options.online, options.budget, options.map.resolution, options.output, inputs);
  checkMemory(options);

  AccumulateOptions reading = accumulateOptions(options.input, options.map.resolution, options.budget.refine.threads);
  if (D == 2) reading = withSlice(reading, options.slice, options.input.crop);
  const FileScans scans =
      openScans(options.input, options.budget.refine.threads, options.online.on ? "option --online" : nullptr);
  noteDroppedFields(scans);
  if (const std::vector<FileSystem> systems = coordinateSystemsOf(scans); !systems.empty())
    task.metadata[kCoordinateSystemEntry] = systems.front().system;
  const WrittenMap written = !options.max_memory.empty() ? buildWithinMemory<D>(options, scans, reading, task)
                             : options.online.on         ? buildOnline<D>(options, scans, reading, task)
                                                         : buildInMemory<D>(options, scans, reading, task);
  warnOfCoordinates(scans, options.map.resolution);
  MapReport report;
  std::vector<std::size_t> gaussians;
  for (const Json& scale : written.scales) gaussians.push_back(scale["gaussians"].get<std::size_t>());
  report.before = summaryOf(scans, written.counts, options.slice) + ", ";
  report.counts = perScale(gaussians);
  report.scales = written.scales;
  report.first = {{"scans", scans.size()}, {"points", countsJson(written.counts)}};
  report.tell_time = true;
  task.report(report);
}

/// Sets the options of the paper. The budget stays as it is.
void applyPaper(Pcd2mapOptions& options) {
  options.online.options = OnlineOptions::yguel2009(options.planar ? 2 : 3);
  options.online.as_in_paper = true;
  options.map = options.online.options.map;
  options.budget.method = "insert";
  options.budget.refine.seed_rule = options.online.options.seed_rule;
}

void addOptions(Command& command, Pcd2mapOptions& options) {
  addScanPaths(command, options.input);
  command.text("-o,--output", options.output.path, "map file to write (.gmap)");
  command.force(options.output.force);
  command.text("--update", options.update, "map file to add the scans to (.gmap)");
  command.flag("--planar", options.planar, "build a planar map (2-D); 3-D scans need --slice Z0 Z1");
  addSlice(command, options.slice).rare();
  const Option as_in_paper = command.preset(
      "--as-in-paper", [&options] { applyPaper(options); }, "use the settings of Yguel et al. 2009");
  command.number("--resolution", options.map.resolution, "side of the finest cells [m]");
  command.number("--scales", options.map.scales, "number of scales");
  command.number("--ratio", options.map.ratio, "ratio of the cell sides of two neighbouring scales").rare();
  command.number("--noise", options.map.noise, "noise floor of every Gaussian [m]; 0 = resolution / 20").rare();
  addBudgetOptions(command, options.budget);
  addOnlineOptions(command, options.online, as_in_paper);
  addScanOptions(command, options.input);
  command
      .text("--max-memory", options.max_memory,
            R"(memory limit [bytes], with suffix k, M or G: builds tile by tile, with a temporary file beside the map;
          the map is the same, but has no error curves)")
      .rare();
  command
      .flag("!--no-curves", options.budget.curves,
            "do not measure the error curves of other budgets (see gaussmap info); faster")
      .rare();
  command.threads(options.budget.refine.threads).rare();
  command.json(options.json);
  command.files({"--output", "--update"}, {".gmap"});
  command.excludes("--update", {"--output", "--force", "--resolution", "--scales", "--ratio", "--noise", "--online",
                                "--max-gaussians", "--max-bytes", "--max-error", "--method", "--max-memory", "--queue",
                                "--max-swaps", "--seed-rule", "--only-occupied", "--learning-factor", "--distance"});
}

}  // namespace

void addPcd2map(CLI::App& app) {
  auto options = std::make_shared<Pcd2mapOptions>();
  Command command(app, "pcd2map", kPcd2mapHelp);
  addOptions(command, *options);
  command.onRun([command, options] {
    const bool updates = command.isGiven("--update");
    if (!updates && !command.isGiven("--output")) throw UsageError("--output is required (or --update MAP)");
    if (!updates && !options->planar && !options->slice.empty())
      throw UsageError("--slice: only for planar maps; add --planar");
    if (!updates) return forDimensions(options->planar ? 2 : 3, [&](auto d) { run<d()>(*options); });
    if (command.isGiven("--budget")) options->update_budget = options->budget.budget;
    updateFromScans(*options);
  });
}

}  // namespace gaussmap::app
