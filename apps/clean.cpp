// SPDX-License-Identifier: BSD-3-Clause
// gaussmap clean SCANS... -o DIR: the scans without the points of moving objects.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <set>

#include "common.h"
#include "evaluation/removal_score.h"
#include "gaussmap/mapping/moving/moving_points.h"
#include "io/pcd/pcd_records.h"

namespace gaussmap::app {
using namespace detail;

namespace {

struct CleanCommand {
  ScanInput input;
  MovingPointOptions options;
  std::string folder, merged, removed, labels;
  double no_return_is_free = 0.0;  // 0: it is no evidence
  bool force = false;
  bool json = false;
};

/// DIR/<name of the scan>. Throws UsageError if two scans have the same name.
std::vector<std::filesystem::path> outputsFor(const PcdScans& scans, const std::string& folder) {
  std::map<std::filesystem::path, std::filesystem::path> taken;
  std::vector<std::filesystem::path> outputs;
  for (const PcdScan& scan : scans.files()) {
    const std::filesystem::path name = scan.path.filename();
    const auto [entry, is_new] = taken.emplace(name, scan.path);
    if (!is_new)
      throw UsageError(scan.path.string() + " and " + entry->second.string() + " would both become " +
                       (std::filesystem::path(folder) / name).string() + ": clean them apart, or use --merged");
    outputs.push_back(std::filesystem::path(folder) / name);
  }
  return outputs;
}

/// Everything that can be wrong with the outputs, before any work is done. Makes the directory.
std::vector<std::filesystem::path> checkOutputs(const CleanCommand& command, const PcdScans& scans) {
  std::vector<std::filesystem::path> inputs;
  inputs.reserve(scans.size() + 1);
  for (const PcdScan& scan : scans.files()) inputs.push_back(scan.path);
  if (!command.input.poses.empty()) inputs.emplace_back(command.input.poses);
  std::vector<std::filesystem::path> outputs;
  if (!command.folder.empty()) outputs = outputsFor(scans, command.folder);
  std::set<std::filesystem::path> taken;
  for (const std::filesystem::path& output : outputs) taken.insert(std::filesystem::weakly_canonical(output));
  for (const std::string& file : {command.merged, command.removed}) {
    if (file.empty()) continue;
    if (!taken.insert(std::filesystem::weakly_canonical(file)).second)
      throw UsageError(file + " is another output of this command already: take another name");
    checkOutput({file, command.force}, inputs);
  }
  if (command.folder.empty()) return {};
  std::error_code error;
  std::filesystem::create_directories(command.folder, error);
  if (error) throw UsageError(command.folder + ": the directory cannot be made: " + error.message());
  for (const std::filesystem::path& output : outputs) checkOutput({output.string(), command.force}, inputs);
  return outputs;
}

void mergeInto(PcdRecords& all, PcdRecords part, const PcdScan& scan, ScanFrame frame) {
  if (frame == ScanFrame::Sensor) moveToMap(part, scan.pose);
  part.width = 0;
  part.viewpoint = Pose();
  if (all.fields.empty()) {
    all = std::move(part);
    return;
  }
  try {
    append(all, part);
  } catch (const std::invalid_argument&) {
    throw FileError(scan.path, "other fields than the scans before: they cannot be merged into one cloud");
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

void run(CleanCommand command) {
  if (command.folder.empty() && command.merged.empty() && command.removed.empty() && command.labels.empty())
    throw UsageError("nothing to do: give -o DIR, --merged FILE, --removed FILE or --labels");
  const double start = now();
  const int threads = command.options.evidence.threads;
  const AccumulateOptions input = accumulateOptions(command.input, command.options.resolution, threads);
  command.options.evidence.max_range = input.max_range;
  if (command.no_return_is_free > 0.0) command.options.evidence.no_return_is_free = command.no_return_is_free;
  const auto all = std::make_shared<const PcdScans>(openScans(command.input));
  const PcdScans& scans = *all;
  if (!command.labels.empty())
    for (std::size_t i = 0; i < scans.size(); ++i)
      if (!scans.reader(i).header().find(command.labels))
        throw FileError(scans.files()[i].path, "no field '" + command.labels + "' to score against");
  const bool writes = !command.folder.empty() || !command.merged.empty() || !command.removed.empty();
  for (std::size_t i = 0; writes && i < scans.size(); ++i) checkWritable(scans.reader(i));
  const std::vector<std::filesystem::path> outputs = checkOutputs(command, scans);

  ProgressBar bar;
  const MovingPoints moving(all, command.options, [&](MovingPointStep, std::size_t done) {
    bar.show({done, scans.size(), 0, 0});
  });

  PcdRecords merged, removed;
  RemovalScore score;
  std::size_t gone = 0, points = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const PcdReader reader = scans.reader(i);
    std::vector<bool> is_moving = moving.inScan(i), is_still = is_moving;
    is_still.flip();
    points += is_moving.size();
    gone += static_cast<std::size_t>(std::count(is_moving.begin(), is_moving.end(), true));
    if (!command.labels.empty()) {
      const std::vector<double> labels = reader.column(command.labels);
      for (std::size_t p = 0; p < labels.size(); ++p) score.add(labels[p] != 0.0, is_moving[p]);
    }
    if (!writes) continue;
    PcdRecords records = readRecords(reader);
    if (!poseFault(records.viewpoint).empty()) records.viewpoint = scans.files()[i].pose;  // --poses stands in for it
    const auto part = [&](const std::vector<bool>& keep, bool organised) {
      PcdRecords kept = records;
      if (!organised) kept.width = 0;
      keepOnly(kept, keep);
      return kept;
    };
    if (!outputs.empty()) writePcd(outputs[i], part(is_still, true));
    if (!command.merged.empty()) mergeInto(merged, part(is_still, false), scans.files()[i], scans.frame());
    if (!command.removed.empty()) mergeInto(removed, part(is_moving, false), scans.files()[i], scans.frame());
  }
  if (!command.merged.empty()) writePcd(command.merged, merged);
  if (!command.removed.empty()) writePcd(command.removed, removed);

  const double seconds = now() - start;
  if (command.json) {
    Json json = {{"scans", scans.size()}, {"points", points}, {"removed", gone}, {"seconds", seconds}};
    if (!command.labels.empty()) json["score"] = jsonOf(score);
    printJson(json);
    return;
  }
  std::cout << scans.size() << (scans.size() == 1 ? " scan, " : " scans, ") << points << " points, " << gone
            << " of them on moving objects, " << std::round(seconds * 100.0) / 100.0 << " s\n";
  if (!command.labels.empty()) print(score);
}

}  // namespace

void addClean(CLI::App& app) {
  auto command = std::make_shared<CleanCommand>();
  CLI::App* sub = app.add_subcommand("clean", "Remove the points of moving objects from scans");
  sub->footer(
      "Looks for cells that some scans hit and others see through. Every field and the VIEWPOINT of the scans stay;\n"
      "in organised clouds removed points become NaN. At least two scans that see the same places are needed.\n"
      "Example: gaussmap clean scans/ -o clean/ --removed removed.pcd");
  sub->add_option("scans", command->input.paths, "PCD files, or directories of them (in natural order)")->required();
  sub->add_option("-o,--output", command->folder, "directory for the cleaned scans, named as they were");
  sub->add_option("--merged", command->merged, "write what holds still as one cloud in the map frame (.pcd)");
  sub->add_option("--removed", command->removed, "write what moved as one cloud in the map frame (.pcd)");
  sub->add_flag("--force", command->force, "replace existing outputs");
  sub->add_option("--labels", command->labels, "score against this field of the scans: 0 = static, else dynamic")
      ->expected(0, 1)
      ->default_str("label");
  sub->add_option("--resolution", command->options.resolution, "side of the finest cells [m]")
      ->check(numberBetween(1e-3, 1e3))
      ->capture_default_str();
  sub->add_option("--no-return-is-free", command->no_return_is_free,
                  "take directions without a return for free space up to this range [m]")
      ->check(numberBetween(1e-3, 1e6));
  addScanOptions(*sub, command->input);
  addThreads(*sub, command->options.evidence.threads);
  sub->add_flag("--json", command->json, "print the result for machines");
  sub->callback([command] { run(*command); });
}

}  // namespace gaussmap::app
