// SPDX-License-Identifier: BSD-3-Clause
// gaussmap segments IN... -o OUT.{pcd,svg,geojson,csv}: a 2-D map of linked line segments.
#include <algorithm>
#include <iostream>
#include <locale>
#include <set>
#include <sstream>

#include "fitter_options.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/logs/carmen_log.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "io/files/atomic_file.h"
#include "laser_input.h"
#include "segment_picture.h"
#include "segment_report.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct SegmentsCommand {
  LaserInput input;
  FitterInput fitter;
  std::vector<std::string> outputs;
  std::string stats, evaluate, walls;
  int every = 1;
  bool force = false, evidence = false, json = false;
};

/// What the command made, and from what.
struct Result {
  SegmentMap map;
  std::vector<Vector<2>> evidence;
  std::vector<LaserScan> left_out;  // by --every
  std::size_t scans = 0, beams = 0, memory = 0;
  double seconds = 0.0;  // of fitting
  std::optional<SegmentPicture::Field> field;
  std::string statistics;  // as CSV
  SegmentStatistics last;
  std::size_t splits = 0, merges = 0, pruned = 0;
};

bool isSegmentMap(const std::vector<std::string>& inputs) {
  if (inputs.size() != 1 || isCarmenLogName(inputs[0]) || std::filesystem::is_directory(inputs[0])) return false;
  const PcdReader reader(inputs[0]);
  return reader.header().find("normal_variance") != nullptr && reader.header().find("chain") != nullptr;
}

using Writer = void (*)(const std::filesystem::path&, const SegmentMap&);

/// Nothing for a picture, which needs more than the map.
Writer writerFor(const std::string& output) {
  const std::string extension = std::filesystem::path(output).extension().string();
  if (extension == ".pcd") return writeSegmentPcd;
  if (extension == ".geojson") return writeSegmentGeoJson;
  if (extension == ".csv") return writeSegmentCsv;
  if (extension == ".svg") return nullptr;
  throw UsageError("'" + output + "': the name must end in .pcd, .svg, .geojson or .csv");
}

void checkOutputs(const SegmentsCommand& command, std::vector<std::filesystem::path> inputs) {
  for (const std::string& file : {command.input.scans.poses, command.evaluate, command.walls})
    if (!file.empty()) inputs.emplace_back(file);
  std::vector<std::string> outputs = command.outputs;
  if (!command.stats.empty()) outputs.push_back(command.stats);
  std::set<std::filesystem::path> taken;
  for (const std::string& output : outputs) {
    if (!taken.insert(std::filesystem::weakly_canonical(output)).second)
      throw UsageError(output + " is another output of this command already: take another name");
    checkOutput({output, command.force}, inputs);
  }
}

/// One line a scan, as in Figs. 7 and 8 of the paper.
void addStatistics(std::ostream& table, std::size_t scan, std::string name, const SegmentStatistics& s) {
  for (std::size_t i = name.find('"'); i != std::string::npos; i = name.find('"', i + 2)) name.insert(i, 1, '"');
  table << scan << ",\"" << name << "\"," << s.beams << ',' << s.associated << ',' << s.created << ',' << s.splits
        << ',' << s.merges << ',' << s.pruned << ',' << s.segments << ',' << s.normal_variance << ',' << s.coverage
        << '\n';
}

Result fit(const SegmentsCommand& command, const LaserScans& input) {
  std::shared_ptr<SegmentUtility> utility = makeUtility(command.fitter);
  SegmentFitter fitter(fitterOptions(command.fitter), std::move(utility));
  std::ostringstream table;
  table.imbue(std::locale::classic());
  table << "scan,file,beams,associated,created,splits,merges,pruned,segments,normal_variance,coverage\n";
  Result result;
  Vector<2> observer(0.0, 0.0);
  const double start = now();
  const auto every = static_cast<std::size_t>(command.every);
  for (std::size_t i = 0; i < input.scans.size(); ++i) {
    if (i % every != 0) {
      result.left_out.push_back(input.scans[i]);
      continue;
    }
    result.last = fitter.add(input.scans[i]);
    observer = input.scans[i].pose.translation;
    addStatistics(table, i, input.names[i], result.last);
    result.beams += result.last.beams;
    result.splits += result.last.splits;
    result.merges += result.last.merges;
    result.pruned += result.last.pruned;
  }
  if (result.beams == 0) throw FileError(input.files.front(), "no beam of the scans returned: there is nothing to map");
  result.map = fitter.map();
  result.seconds = now() - start;
  result.scans = fitter.scans();
  result.memory = fitter.memoryBytes();
  result.statistics = table.str();
  if (command.evidence) result.evidence = fitter.evidence();
  const FitterInput& fitting = command.fitter;
  if (!fitting.viewpoint.empty()) {
    result.field = SegmentPicture::Field{{fitting.viewpoint[0], fitting.viewpoint[1]}, fitting.viewpoint[2]};
  } else if (fitting.utility == "viewpoint-dependent") {
    result.field = SegmentPicture::Field{observer, fitting.view_radius.value_or(ViewpointDependentOptions().radius)};
  }
  return result;
}

/// Scans to score on: of a log or directory of its own, or those of the inputs that --every left out.
LaserScans testScans(const SegmentsCommand& command, const std::vector<LaserScan>& left_out) {
  const std::vector<std::string>& inputs = command.input.scans.paths;
  std::error_code error;
  const bool is_input = std::any_of(inputs.begin(), inputs.end(), [&](const std::string& input) {
    return std::filesystem::equivalent(input, command.evaluate, error);
  });
  LaserScans test;
  if (is_input) {
    test.scans = left_out;
  } else {
    LaserInput input = command.input;
    input.scans.paths = {command.evaluate};
    input.scans.poses.clear();
    test = readLaserScans(input);
  }
  if (test.scans.empty())
    throw UsageError("--evaluate: all scans are in the map; --every 2 leaves every other one out");
  return test;
}

/// Throws UsageError for options that a finished map has no use for.
void checkFinished(const CLI::App& app, const SegmentsCommand& command) {
  std::string option = givenFitterOption(app);
  if (!command.stats.empty()) option = "--stats";
  if (command.evidence) option = "--evidence";
  if (command.every > 1) option = "--every";
  if (!option.empty())
    throw UsageError(option + ": " + command.input.scans.paths[0] + " is a finished map of segments");
}

void printMap(const SegmentsCommand& command, const Result& result) {
  for (const std::string& output : command.outputs)
    std::cout << output << (&output == &command.outputs.back() ? ": " : ", ");
  std::cout << result.map.segments.size() << " segments in " << result.map.chains.size() << " chains, "
            << rounded("%.1f m", result.map.totalLength());
  if (result.scans > 0)
    std::cout << "; " << result.scans << " scans, " << result.beams << " beams, "
              << rounded("%.0f beams/s, ", static_cast<double>(result.beams) / std::max(result.seconds, 1e-9))
              << humanBytes(result.memory);
  std::cout << '\n';
}
Json mapJson(const SegmentsCommand& command, const Result& result) {
  Json json = {{"output", command.outputs},
               {"segments", result.map.segments.size()},
               {"chains", result.map.chains.size()},
               {"length", result.map.totalLength()}};
  if (result.scans > 0)
    json.update(Json{{"scans", result.scans},
                     {"beams", result.beams},
                     {"normal_variance", result.last.normal_variance},
                     {"splits", result.splits},
                     {"merges", result.merges},
                     {"pruned", result.pruned},
                     {"memory", result.memory},
                     {"seconds", result.seconds}});
  return json;
}

void run(const CLI::App& app, const SegmentsCommand& command) {
  if (command.outputs.empty() && command.stats.empty() && command.evaluate.empty() && command.walls.empty())
    throw UsageError("nothing to do: give -o FILE, --stats FILE, --evaluate LOG or --walls FILE");
  for (const std::string& output : command.outputs) writerFor(output);
  checkOutputs(command, {command.input.scans.paths.begin(), command.input.scans.paths.end()});
  Result result;
  if (isSegmentMap(command.input.scans.paths)) {
    checkFinished(app, command);
    result.map = readSegmentPcd(command.input.scans.paths[0]);
  } else {
    fitterOptions(command.fitter);  // its complaints come before the work of reading
    makeUtility(command.fitter);
    const LaserScans input = readLaserScans(command.input);
    checkOutputs(command, input.files);
    result = fit(command, input);
  }
  std::optional<HoldOutScore> held_out;
  LaserScans test;
  if (!command.evaluate.empty()) {
    test = testScans(command, result.left_out);
    checkOutputs(command, test.files);
    held_out = scoreHoldOut(result.map, test.scans);
  }
  std::optional<WallScore> walls;
  if (!command.walls.empty()) walls = scoreWalls(result.map, readSegmentPcd(command.walls).segments);

  for (const std::string& output : command.outputs) {
    if (const Writer write = writerFor(output)) {
      write(output, result.map);
    } else {
      drawSegments(result.map, {result.evidence, result.field}, output);
    }
  }
  if (!command.stats.empty()) {
    AtomicFile file(command.stats);
    file.write(result.statistics.data(), result.statistics.size());
    file.commit();
  }
  if (command.json) {
    Json json = mapJson(command, result);
    if (held_out) json["held_out"] = scoreJson(*held_out, test.scans.size());
    if (walls) json["walls"] = scoreJson(*walls);
    return printJson(json);
  }
  printMap(command, result);
  if (held_out) printScore(*held_out, test.scans.size());
  if (walls) printScore(*walls);
}

}  // namespace

void addSegments(CLI::App& app) {
  auto options = std::make_shared<SegmentsCommand>();
  CLI::App* command = app.add_subcommand("segments", "A 2-D map of linked line segments from scans of a planar laser");
  command->footer(
      "Reads scans in their order and ends with one map: the walls that were seen, free space on their left, linked "
      "into\n"
      "chains. PCD comes back as input, to be evaluated or written in another format.\n"
      "Example: gaussmap segments lab.log.gz -o lab.svg -o lab.pcd --every 2 --evaluate lab.log.gz");
  addLaserOptions(*command, options->input);
  command
      ->add_option("-o,--output", options->outputs,
                   "map to write: .pcd, .svg, .geojson or .csv; may be given several times")
      ->allow_extra_args(false);
  command->add_flag("--force", options->force, "replace existing outputs");
  command->add_flag("--evidence", options->evidence, "draw what the segments remember into the .svg");
  command->add_option("--every", options->every, "map every N-th scan only, from the first on")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--stats", options->stats, "write what each scan did (.csv)");
  command->add_option(
      "--evaluate", options->evaluate,
      "score the map on the scans of a log, scan or directory; of an input: on those --every leaves out");
  command->add_option("--walls", options->walls, "score the map against true walls (walls.pcd of simulate plan)");
  addFitterOptions(*command, options->fitter);
  command->add_flag("--json", options->json, "print the result for machines");
  command->callback([command, options] { run(*command, *options); });
}

}  // namespace gaussmap::app
