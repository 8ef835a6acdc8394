// SPDX-License-Identifier: BSD-3-Clause
// gaussmap clean SCANS... -o DIR: removes the points of moving objects from scans.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <utility>

#include "commands/commands.h"
#include "commands/depth_noise.h"
#include "commands/evidence_options.h"
#include "commands/scan_input.h"
#include "common/command.h"
#include "common/json.h"
#include "common/progress_bar.h"
#include "common/report.h"
#include "evaluation/removal_score.h"
#include "gaussmap/mapping/moving/moving_points.h"
#include "io/pcd/scan_records.h"
#include "io/scans/scan_names.h"

namespace gaussmap::app {
using namespace detail;

namespace {

const Help kCleanHelp = {
    "Remove the points of moving objects from scans", "gaussmap clean scans/ -o clean/ --removed removed.pcd",
    R"(Finds cells that some scans hit and other scans see through. At least two scans of the same place are needed. The
scans keep all their fields and their VIEWPOINT. In organised clouds, removed points become NaN.

--merged and --removed write x y z as doubles (F 8) if floats would round them by a thousandth of --resolution.
Points that --max-range, --min-range or --crop drop are not tested, but stay in the outputs.)"};

struct CleanCommand {
  ScanInput input;
  MovingPointOptions options;
  std::vector<double> depth_noise;
  std::string folder, merged, removed, labels;
  bool force = false;
  bool json = false;

  bool writes() const { return !folder.empty() || !merged.empty() || !removed.empty(); }
};

/// Returns the names of the cleaned scans. Scans of files with several scans get a number: drive_000007.pcd.
std::vector<std::filesystem::path> copiesOf(const FileScans& scans) {
  std::vector<std::filesystem::path> files;
  std::vector<std::size_t> file_of;  // per scan
  for (const FileScan& scan : scans.files()) {
    const bool is_same_file = !scan.name.empty() && !files.empty() && files.back() == scan.path;
    if (!is_same_file) files.push_back(scan.path);
    file_of.push_back(files.size() - 1);
  }
  const std::vector<std::filesystem::path> names = scanCopies(files);
  std::vector<std::filesystem::path> copies;
  for (std::size_t i = 0; i < file_of.size(); ++i) {
    std::filesystem::path& copy = copies.emplace_back(names[file_of[i]]);
    const FileScan& scan = scans.files()[i];
    if (!scans.pcd(i)) copy.replace_extension(".pcd");
    if (scan.name.empty()) continue;
    std::string number = std::to_string(scan.index);
    number.insert(0, 6 - std::min<std::size_t>(6, number.size()), '0');
    copy.replace_filename(copy.stem().string() + "_" + number + ".pcd");
  }
  return copies;
}

/// Returns the path of each cleaned scan: FOLDER/NAME, or FOLDER/000000/cloud.pcd if the scans are called so. Throws
/// UsageError if two scans have the same name.
std::vector<std::filesystem::path> outputsFor(const FileScans& scans, const std::string& folder) {
  std::map<std::filesystem::path, std::filesystem::path> taken;
  std::vector<std::filesystem::path> outputs;
  const std::vector<std::filesystem::path> copies = copiesOf(scans);
  for (std::size_t i = 0; i < copies.size(); ++i) {
    const FileScan& scan = scans.files()[i];
    const std::filesystem::path& name = copies[i];
    const auto [entry, is_new] = taken.emplace(name, scan.path);
    if (!is_new)
      throw UsageError(scan.path.string() + " and " + entry->second.string() + " would both become " +
                       (std::filesystem::path(folder) / name).string() + "; clean them separately or use --merged");
    outputs.push_back(std::filesystem::path(folder) / name);
  }
  return outputs;
}

/// Checks all outputs, creates the directory, and returns the paths of the cleaned scans. Throws UsageError.
std::vector<std::filesystem::path> checkedOutputs(const CleanCommand& command, const FileScans& scans) {
  std::vector<std::filesystem::path> inputs;
  inputs.reserve(scans.size() + 1);
  for (const FileScan& scan : scans.files()) inputs.push_back(scan.path);
  if (!command.input.poses.empty()) inputs.emplace_back(command.input.poses);
  std::vector<std::filesystem::path> outputs;
  if (!command.folder.empty()) outputs = outputsFor(scans, command.folder);
  checkOutputs({command.merged, command.removed}, command.force, inputs, outputs);
  refuseOtherKinds(command.merged, "a PCD file", {".pcd"});
  refuseOtherKinds(command.removed, "a PCD file", {".pcd"});
  if (endingOf(command.folder) == ".pcd")
    throw UsageError("-o " + command.folder +
                     ": the cleaned scans are files of a directory, whose name must not end in " +
                     ".pcd; use --merged for one file");
  if (command.folder.empty()) return {};
  makeFolder(command.folder);
  for (const std::filesystem::path& output : outputs) makeFolder(output.parent_path());
  for (const std::filesystem::path& output : outputs) checkOutput({output.string(), command.force}, inputs);
  return outputs;
}

/// `precision` [m]: if floats round coordinates of the map frame by more, they become doubles.
void mergeInto(PcdRecords& all, PcdRecords part, const FileScan& scan, ScanFrame frame, double precision) {
  if (frame == ScanFrame::Sensor) moveToMap(part, scan.pose, precision);
  part.width = 0;
  part.viewpoint = Pose();
  if (all.fields.empty()) {
    all = std::move(part);
    return;
  }
  try {
    append(all, std::move(part));
  } catch (const std::invalid_argument&) {
    throw FileError(scan.path, "has other fields than the scans before, so they cannot be merged into one cloud");
  }
}

Json jsonOf(const RemovalScore& score) {
  return {{"static_points", score.still},    {"static_kept", score.still_kept},
          {"dynamic_points", score.moving},  {"dynamic_removed", score.moving_removed},
          {"SA", score.staticAccuracy()},    {"DA", score.dynamicAccuracy()},
          {"AA", score.associatedAccuracy()}};
}

void print(const RemovalScore& score) {
  const auto percent = [](double share) { return std::round(share * 1e5) / 1e3; };
  std::cout << "SA " << percent(score.staticAccuracy()) << " % of " << score.still << " static points kept, DA "
            << percent(score.dynamicAccuracy()) << " % of " << score.moving << " dynamic points removed, AA "
            << percent(score.associatedAccuracy()) << " %\n";
}

/// The counts of the points, and the score.
struct Cleaned {
  std::size_t points = 0, removed = 0;
  RemovalScore score;
};

bool hasValue(const FileScans& scans, std::size_t index, const std::string& name) {
  const std::vector<std::string> names = scans.open(index)->valueNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Returns all points of a scan with all their values.
PcdRecords recordsOf(const FileScans& scans, std::size_t index) {
  const Pose& pose = scans.files()[index].pose;
  const std::optional<PcdReader> pcd = scans.pcd(index);
  if (!pcd) return detail::recordsOf(*scans.open(index), pose);
  PcdRecords records = readRecords(*pcd);
  if (!poseFault(records.viewpoint).empty()) records.viewpoint = pose;  // the pose of --poses
  return records;
}

/// Throws FileError for scans that cannot be scored or written. Runs before the long computation.
void checkScans(const CleanCommand& command, const FileScans& scans) {
  if (!command.labels.empty())
    for (std::size_t i = 0; i < scans.size(); ++i)
      if (!hasValue(scans, i, command.labels))
        throw FileError(scans.files()[i].path, "no field '" + command.labels + "', which --labels needs for the score");
  if (command.writes())
    for (std::size_t i = 0; i < scans.size(); ++i)
      if (const std::optional<PcdReader> pcd = scans.pcd(i)) checkWritable(*pcd);
}

/// Writes every scan without its moving points. `outputs` has one path per scan, or is empty.
Cleaned writeCleaned(const CleanCommand& command, const FileScans& scans, const MovingPoints& moving,
                     const std::vector<std::filesystem::path>& outputs) {
  Cleaned cleaned;
  PcdRecords merged, removed;
  const double precision = 1e-3 * command.options.resolution;
  bool floats = true;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    std::vector<bool> is_moving = moving.inScan(i), is_still = is_moving;
    is_still.flip();
    cleaned.points += is_moving.size();
    cleaned.removed += static_cast<std::size_t>(std::count(is_moving.begin(), is_moving.end(), true));
    if (!command.labels.empty()) {
      const std::vector<double> labels = scans.open(i)->values(command.labels);
      for (std::size_t p = 0; p < labels.size(); ++p) cleaned.score.add(labels[p] != 0.0, is_moving[p]);
    }
    if (!command.writes()) continue;
    const PcdRecords records = recordsOf(scans, i);
    const auto part = [&](const std::vector<bool>& keep, bool organised) {
      PcdRecords kept = records;
      if (!organised) kept.width = 0;
      keepOnly(kept, keep);
      return kept;
    };
    if (!outputs.empty()) writePcd(outputs[i], part(is_still, true));
    floats &= records.fields.empty() || hasFloatCoordinates(records);
    if (!command.merged.empty()) mergeInto(merged, part(is_still, false), scans.files()[i], scans.frame(), precision);
    if (!command.removed.empty())
      mergeInto(removed, part(is_moving, false), scans.files()[i], scans.frame(), precision);
  }
  for (const auto& [path, cloud] : {std::pair(&command.merged, &merged), std::pair(&command.removed, &removed)})
    if (!path->empty() && floats && cloud->size() > 0 && !hasFloatCoordinates(*cloud))
      warn(*path +
           ": x y z are doubles (F 8), because floats would round them that far from the origin; PCL's point "
           "types read only floats");
  if (!command.merged.empty()) writePcd(command.merged, merged);
  if (!command.removed.empty()) writePcd(command.removed, removed);
  return cleaned;
}

void run(CleanCommand command) {
  if (!command.writes() && command.labels.empty())
    throw UsageError("nothing to do: give -o DIR, --merged FILE, --removed FILE or --labels");
  checkLink(command.options.cells.link, command.options.resolution);
  const double start = now();
  ScanEvidenceOptions& evidence = command.options.evidence;
  const AccumulateOptions input = accumulateOptions(command.input, command.options.resolution, evidence.threads);
  evidence.max_range = input.max_range;
  evidence.min_range = input.min_range;
  evidence.crop = input.crop;
  evidence.visibility.noise = depthNoise(command.depth_noise);
  const auto files = std::make_shared<const FileScans>(openScans(command.input, evidence.threads, "command clean"));
  const FileScans& scans = *files;
  if (scans.size() == 1)
    throw FileError(scans.files()[0].path,
                    "one cloud alone shows no motion, and a cloud that was merged from scans does not say where the "
                    "rays began; give one file per scan, at least two of the same place");
  checkScans(command, scans);
  const std::vector<std::filesystem::path> outputs = checkedOutputs(command, scans);
  ProgressBar bar;
  const MovingPoints moving(files, command.options, [&](MovingPointStep, std::size_t done) {
    bar.show({done, scans.size(), 0, 0});
  });
  warnOfCoordinates(scans, command.options.resolution);
  const Cleaned cleaned = writeCleaned(command, scans, moving, outputs);

  const double seconds = now() - start;
  if (command.json) {
    Json json = {
        {"scans", scans.size()}, {"points", cleaned.points}, {"removed", cleaned.removed}, {"seconds", seconds}};
    if (!command.labels.empty()) json["score"] = jsonOf(cleaned.score);
    return printJson(json);
  }
  std::cout << scans.size() << (scans.size() == 1 ? " scan, " : " scans, ") << cleaned.points << " points, "
            << cleaned.removed << " of them on moving objects, " << secondsText(seconds) << " s\n";
  if (!command.labels.empty()) print(cleaned.score);
}

}  // namespace

void addClean(CLI::App& app) {
  auto options = std::make_shared<CleanCommand>();
  Command command(app, "clean", kCleanHelp);
  addScanPaths(command, options->input);
  command.text("-o,--output", options->folder, "directory for the cleaned scans, which keep their file names");
  command.text("--merged", options->merged, "write the static points as one cloud in the map frame (.pcd)");
  command.text("--removed", options->removed, "write the moving points as one cloud in the map frame (.pcd)");
  command.force(options->force, "replace existing outputs");
  command.text("--labels", options->labels, "score against this field of the scans: 0 = static, other values = dynamic")
      .valueMayBeMissing("label");
  command.number("--resolution", options->options.resolution, 1e-3, 1e3, "side of the finest cells [m]");
  command
      .number("--no-return-is-free", options->options.evidence.no_return_is_free, 1e-3, 1e6,
              "treat directions without a return as free space up to this range [m]")
      .rare();
  addDepthNoise(command, options->depth_noise);
  MovingPointOptions& moving = options->options;
  for (const Option& option : addEvidenceOptions(
           command, {moving.cells.occupancy, moving.evidence.visibility, moving.cells.link, moving.cells.reach}))
    option.group("Constants");
  addScanOptions(command, options->input);
  command.threads(options->options.evidence.threads);
  command.json(options->json);
  command.folders({"--output"});
  command.files({"--merged", "--removed"}, {".pcd"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
