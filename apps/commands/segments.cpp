// SPDX-License-Identifier: BSD-3-Clause
// gaussmap segments IN... -o OUT.{pcd,svg,geojson,csv}: builds a 2-D map of linked line segments.
#include "commands/segments/segments.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "commands/commands.h"
#include "commands/segments/segment_report.h"
#include "common/box.h"
#include "common/command.h"
#include "common/json.h"
#include "common/report.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/logs/carmen_log.h"

namespace gaussmap::app {
using namespace detail;

namespace {

const Help kSegmentsHelp = {
    "Build a 2-D map of linked line segments from scans of a planar laser",
    "gaussmap segments lab.log.gz -o lab.svg -o lab.pcd --every 2 --evaluate lab.log.gz",
    R"(Reads the scans in their order and writes one map of segments. Each segment has the free space on its left side.
Neighbouring segments are linked into chains. A map that was written as .pcd can be the input too, to evaluate it
or to write it in another format.)"};

/// Throws UsageError for outputs that cannot be written or would destroy an input file.
void checkFiles(const SegmentsCommand& command, std::vector<std::filesystem::path> inputs) {
  for (const std::string& file :
       {command.input.scans.poses, command.evaluate, command.walls, command.fitter.observer_path})
    if (!file.empty()) inputs.emplace_back(file);
  std::vector<std::string> outputs = command.outputs;
  outputs.push_back(command.stats);
  checkOutputs(outputs, command.force, inputs);
  refuseOtherKinds(command.stats, "a table", {".csv", ".txt"});
}

/// Throws UsageError for options that do not apply if the input is a finished map.
void checkFinished(const Command& given, const SegmentsCommand& command) {
  std::string option = givenFitterOption(given);
  if (!command.stats.empty()) option = "--stats";
  if (command.evidence) option = "--evidence";
  if (command.evidence_beside) option = "--evidence-beside";
  if (command.every > 1) option = "--every";
  if (!option.empty())
    throw UsageError(option + ": only for scans, but " + command.input.scans.paths[0] +
                     " is a finished map of segments");
}

std::optional<Box<2>> windowOf(const SegmentsCommand& command) {
  if (command.box.empty()) return {};
  return mapBoxOf<2>("--box", command.box);
}

/// Reads a finished map, or fits a map to scans.
FittedSegments mapOf(const Command& given, const SegmentsCommand& command) {
  const std::vector<std::string>& paths = command.input.scans.paths;
  const bool is_pcd = paths.size() == 1 && !isCarmenLogName(paths[0]) && !std::filesystem::is_directory(paths[0]);
  if (is_pcd && isSegmentPcd(paths[0])) {
    checkFinished(given, command);
    FittedSegments finished;
    finished.map = loadSegmentsPcd(paths[0]);
    finished.picture.window = windowOf(command);
    return finished;
  }
  fitterOptions(command.fitter);  // throws for wrong options before the scans are read
  makeUtility(command.fitter);
  const LaserScans input = readLaserScans(command.input);
  checkFiles(command, input.files);
  FittedSegments fitted = fitSegments(command, input);
  fitted.picture.window = windowOf(command);
  fitted.picture.beside = command.evidence_beside;
  return fitted;
}

void printMap(const SegmentsCommand& command, const FittedSegments& fitted) {
  for (const std::string& output : command.outputs)
    std::cout << output << (&output == &command.outputs.back() ? ": " : ", ");
  std::cout << fitted.map.segments.size() << " segments in " << fitted.map.chains.size() << " chains, "
            << formatted("%.1f m", fitted.map.totalLength());
  if (fitted.scans > 0)
    std::cout << "; " << fitted.scans << " scans, " << fitted.beams << " beams, "
              << formatted("%.0f beams/s, ", static_cast<double>(fitted.beams) / std::max(fitted.seconds, 1e-9))
              << humanBytes(fitted.memory);
  if (!fitted.picture.path.empty())
    std::cout << "; observer: " << fitted.picture.path.size() << " positions, " << fitted.observer_splits << " splits, "
              << fitted.observer_merges << " merges";
  std::cout << '\n';
}

Json mapJson(const SegmentsCommand& command, const FittedSegments& fitted) {
  Json json = {{"output", command.outputs},
               {"segments", fitted.map.segments.size()},
               {"chains", fitted.map.chains.size()},
               {"length", fitted.map.totalLength()}};
  if (fitted.scans > 0)
    json.update(Json{{"scans", fitted.scans},
                     {"beams", fitted.beams},
                     {"normal_variance", fitted.last.normal_variance},
                     {"splits", fitted.splits},
                     {"merges", fitted.merges},
                     {"pruned", fitted.pruned},
                     {"memory", fitted.memory},
                     {"seconds", fitted.seconds}});
  if (command.fitter.as_in_paper) json["as_in_paper"] = true;
  if (!fitted.picture.path.empty())
    json["observer"] = {{"positions", fitted.picture.path.size()},
                        {"splits", fitted.observer_splits},
                        {"merges", fitted.observer_merges}};
  return json;
}

/// Draws one observation, without a map.
void runObservation(const SegmentsCommand& command) {
  std::string option;
  if (!command.stats.empty()) option = "--stats";
  if (!command.evaluate.empty()) option = "--evaluate";
  if (!command.walls.empty()) option = "--walls";
  if (!command.box.empty()) option = "--box";
  if (command.evidence) option = "--evidence";
  if (command.evidence_beside) option = "--evidence-beside";
  if (!option.empty()) throw UsageError(option + ": not with --observation, which makes no map");
  if (command.outputs.empty()) throw UsageError("--observation: no output; give -o FILE.svg");
  for (const std::string& output : command.outputs) requireExtension(output, ".svg");
  fitterOptions(command.fitter);
  checkFiles(command, {command.input.scans.paths.begin(), command.input.scans.paths.end()});
  const LaserScans input = readLaserScans(command.input);
  checkFiles(command, input.files);
  drawOneObservation(command, input);
}

void run(const Command& given, const SegmentsCommand& command) {
  if (!command.observation.empty()) return runObservation(command);
  if (command.outputs.empty() && command.stats.empty() && command.evaluate.empty() && command.walls.empty())
    throw UsageError("nothing to do: give -o FILE, --stats FILE, --evaluate LOG or --walls FILE");
  for (const std::string& output : command.outputs) checkSegmentsName(output);
  checkFiles(command, {command.input.scans.paths.begin(), command.input.scans.paths.end()});
  const FittedSegments fitted = mapOf(given, command);
  std::optional<HoldOutScore> held_out;
  LaserScans test;
  if (!command.evaluate.empty()) {
    test = testScans(command, fitted.left_out);
    checkFiles(command, test.files);
    held_out = scoreHoldOut(fitted.map, test.scans);
  }
  std::optional<WallScore> walls;
  if (!command.walls.empty()) walls = scoreWalls(fitted.map, loadSegmentsPcd(command.walls).segments);

  for (const std::string& output : command.outputs) writeSegments(output, fitted);
  if (!command.stats.empty()) writeText(command.stats, fitted.statistics);
  if (command.json) {
    Json json = mapJson(command, fitted);
    if (held_out) json["held_out"] = scoreJson(*held_out, test.scans.size());
    if (walls) json["walls"] = scoreJson(*walls);
    return printJson(json);
  }
  printMap(command, fitted);
  if (held_out) printScore(*held_out, test.scans.size());
  if (walls) printScore(*walls);
}

}  // namespace

void addSegments(CLI::App& app) {
  auto options = std::make_shared<SegmentsCommand>();
  Command command(app, "segments", kSegmentsHelp);
  addLaserOptions(command, options->input);
  command.texts("-o,--output", options->outputs, "map to write: .pcd, .svg, .geojson or .csv; repeatable").onePerUse();
  command.force(options->force, "replace existing outputs");
  command.flag("--evidence", options->evidence, "draw the evidence of the segments into the .svg");
  command
      .flag("--evidence-beside", options->evidence_beside,
            "draw the evidence beside the segments, not under them (the paper's Fig. 6)")
      .rare();
  command.numbers("--box", options->box, 4, -1e9, 1e9, "draw only the part from x0 y0 to x1 y1 [m]")
      .type("X0 Y0 X1 Y1")
      .rare();
  command
      .text("--observation", options->observation,
            "draw one observation instead of a map: SCAN:BEAM, both counted from 0. It is drawn as a Gaussian and as "
            "particles, before and after the projection into the plane (the paper's Figs. 1 and 2)")
      .rare();
  command.number("--every", options->every, 1, 1000000, "use only every N-th scan, starting with the first one");
  command.text("--stats", options->stats, "CSV file to write: what each scan changed");
  command.text("--evaluate", options->evaluate,
               "score the map on a log, scan or directory; for an input, on the scans that --every leaves out");
  command.text("--walls", options->walls, "score the map against true walls (walls.pcd of simulate plan)");
  addFitterOptions(command, options->fitter);
  command.json(options->json);
  command.files({"--output"}, {".pcd", ".svg", ".geojson", ".csv"});
  command.files({"--stats"}, {".csv"});
  command.files({"--evaluate"}, {".log", ".log.gz", ".pcd"});
  command.files({"--walls"}, {".pcd"});
  command.onRun([command, options] { run(command, *options); });
}

}  // namespace gaussmap::app
