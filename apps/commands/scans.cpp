// SPDX-License-Identifier: BSD-3-Clause
// gaussmap scans INPUT...: shows what pcd2map would read, without building a map.
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include "commands/commands.h"
#include "commands/recordings.h"
#include "commands/scan_input.h"
#include "commands/topic_table.h"
#include "common/command.h"
#include "common/json.h"
#include "common/progress_bar.h"
#include "common/report.h"
#include "core/accept_points.h"

namespace gaussmap::app {
namespace {

const Help kScansHelp = {
    "Show scans, their poses and warnings, without building a map", "gaussmap scans scans/ --poses poses.txt",
    R"(Reads the scans as pcd2map does, and prints one table: files, kind, points, fields, times, how poses were found and
matched, the box around the points in the map frame, and all warnings. For a recording, a list of its topics comes
first: type, number of messages, rate, times and frame. The exit code is 1 if pcd2map would stop, for example because
a scan has no pose, or because a recording has several topics with scans.)"};

struct ScansCommand {
  ScanInput input;
  double resolution = MapOptions().resolution;  // [m]
  bool each = false;
  bool json = false;
};

/// What the points of one scan are.
struct ScanPoints {
  PointCounts counts;
  std::optional<Box<3>> box;  // map frame
};

Json vectorJson(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void extend(std::optional<Box<3>>& box, const Eigen::Vector3d& point) {
  if (!box) box = Box<3>{point, point};
  box->low = box->low.cwiseMin(point);
  box->high = box->high.cwiseMax(point);
}

ScanPoints pointsOf(const FileScans& scans, std::size_t index, const detail::PointLimits& limits) {
  ScanPoints result;
  const Pose pose = scans.info(index).pose;
  const std::unique_ptr<ScanReader> reader = scans.open(index);
  PointBlock<3> block;
  for (std::size_t first = 0, step = 0; first < reader->size(); first += step) {
    reader->read(first, block);
    step = block.size;
    if (step == 0) break;
    result.counts += acceptPoints(pose, scans.frame(), limits, block);
    for (std::size_t i = 0; i < block.size; ++i)
      extend(result.box, {block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i]});
  }
  reader->requireWhole();
  return result;
}

std::string fieldsText(const FileScans& scans, std::size_t index) {
  std::string text;
  if (const std::optional<PcdReader> pcd = scans.pcd(index)) {
    for (const PcdField& field : pcd->header().fields) {
      if (field.name == "_") continue;
      text += (text.empty() ? "" : " ") + field.name;
      if (field.count > 1) text += "[" + std::to_string(field.count) + "]";
    }
    return text;
  }
  text = "x y z";
  for (const std::string& name : scans.open(index)->valueNames()) text += " " + name;
  return text;
}

/// "PCD binary", or "PCD binary (4), PCD ascii (2)" if the scans differ.
std::string listed(const std::map<std::string, std::size_t>& kinds) {
  std::string text;
  for (const auto& [kind, count] : kinds)
    text += (text.empty() ? "" : ", ") + kind + (kinds.size() > 1 ? " (" + std::to_string(count) + ")" : "");
  return text;
}

struct Table {
  std::vector<ScanPoints> points;
  PointCounts counts;
  std::optional<Box<3>> box;
  std::map<std::string, std::size_t> kinds, fields;
  std::vector<double> times;
};

Table tableOf(const FileScans& scans, const detail::PointLimits& limits) {
  Table table;
  ProgressBar bar;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    table.points.push_back(pointsOf(scans, i, limits));
    const ScanPoints& points = table.points.back();
    table.counts += points.counts;
    if (points.box) extend(table.box, points.box->low), extend(table.box, points.box->high);
    ++table.kinds[scans.kind(i)];
    ++table.fields[fieldsText(scans, i)];
    if (scans.files()[i].time) table.times.push_back(*scans.files()[i].time);
    bar.show({i + 1, scans.size(), 0, 0});
  }
  std::sort(table.times.begin(), table.times.end());
  return table;
}

std::string timesText(const std::vector<double>& times) {
  if (times.empty()) return "unknown (no times in the files or their names)";
  std::string text = formatted("%.6f", times.front()) + " .. " + formatted("%.6f", times.back()) + " s";
  if (times.size() > 1)
    text += ", mean interval " +
            formatted("%.4g", (times.back() - times.front()) / static_cast<double>(times.size() - 1)) + " s";
  return text;
}

std::string boxText(const std::optional<Box<3>>& box) {
  if (!box) return "none";
  std::string text;
  for (const auto* corner : {&box->low, &box->high}) {
    text += text.empty() ? "[" : " .. [";
    for (int axis = 0; axis < 3; ++axis) text += (axis > 0 ? " " : "") + formatted("%.2f", (*corner)(axis));
    text += "]";
  }
  return text + " m";
}

/// "6: a.pcd .. f.pcd", or "178 in drive.bag".
std::string filesText(const std::vector<FileScan>& files) {
  std::string text = std::to_string(files.size());
  if (files.empty()) return text;
  const std::string first = files.front().path.string(), last = files.back().path.string();
  if (first == last) return text + (files.size() == 1 ? ": " : " scans in ") + first;
  return text + ": " + first + " .. " + last;
}

Json jsonOf(const FoundScans& found, const Table& table, Json recordings) {
  Json scans = Json::array();
  for (std::size_t i = 0; i < found.scans.size(); ++i) {
    const FileScan& scan = found.scans.files()[i];
    const Pose::Rotation& q = scan.pose.rotation;
    Json one = {{"file", scan.path.string()},
                {"kind", found.scans.kind(i)},
                {"points", table.points[i].counts.read},
                {"accepted", table.points[i].counts.accepted},
                {"fields", fieldsText(found.scans, i)},
                {"translation", vectorJson(scan.pose.translation)},
                {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
    if (!scan.name.empty()) one["scan"] = scan.name;
    if (scan.time) one["time"] = *scan.time;
    if (const std::string system = found.scans.coordinateSystem(i); !system.empty()) one["coordinate_system"] = system;
    scans.push_back(std::move(one));
  }
  Json json = {{"scans", scans},
               {"points",
                {{"read", table.counts.read},
                 {"accepted", table.counts.accepted},
                 {"non_finite", table.counts.non_finite},
                 {"at_sensor", table.counts.at_sensor},
                 {"beyond_range", table.counts.beyond_range},
                 {"too_near", table.counts.too_near},
                 {"outside_crop", table.counts.outside}}},
               {"poses", found.poses},
               {"without_pose", found.without_pose},
               {"warnings", found.warnings}};
  if (!recordings.empty()) json["recordings"] = std::move(recordings);
  if (!table.times.empty()) json["times"] = {table.times.front(), table.times.back()};
  if (table.box) json["box"] = {{"low", vectorJson(table.box->low)}, {"high", vectorJson(table.box->high)}};
  return json;
}

void printRow(const char* name, const std::string& value) {
  std::printf("%-10s %s\n", name, value.c_str());
}

void print(const FoundScans& found, const Table& table, bool each) {
  const std::vector<FileScan>& files = found.scans.files();
  printRow("files", filesText(files));
  printRow("kind", listed(table.kinds));
  std::string points = std::to_string(table.counts.accepted);
  if (table.counts.accepted < table.counts.read)
    points += " (left out: " + std::to_string(table.counts.non_finite) + " not finite, " +
              std::to_string(table.counts.at_sensor) + " at range 0, " + std::to_string(table.counts.beyond_range) +
              " too far, " + std::to_string(table.counts.too_near) + " too near, " +
              std::to_string(table.counts.outside) + " outside the box)";
  printRow("points", points);
  printRow("fields", listed(table.fields));
  printRow("times", timesText(table.times));
  printRow("poses", found.poses);
  for (const std::string& scan : found.without_pose) printRow("no pose", scan);
  for (const FileSystem& system : coordinateSystemsOf(found.scans)) printRow("crs", nameOfSystem(system.system));
  printRow("box", boxText(table.box));
  if (found.warnings.empty()) printRow("warnings", "none");
  for (const std::string& warning : found.warnings) printRow("warning", warning);
  if (!each) return;
  std::printf("\n%10s %18s %10s %10s %10s  %s\n", "points", "time [s]", "x [m]", "y [m]", "z [m]", "file");
  for (std::size_t i = 0; i < files.size(); ++i) {
    const Eigen::Vector3d& t = files[i].pose.translation;
    std::printf("%10s %18s %10.3f %10.3f %10.3f  %s\n", std::to_string(table.points[i].counts.accepted).c_str(),
                files[i].time ? formatted("%.6f", *files[i].time).c_str() : "-", t.x(), t.y(), t.z(),
                found.scans.info(i).name.c_str());
  }
}

/// Prints the table. Throws std::runtime_error with the reason if pcd2map would stop.
void run(const ScansCommand& command) {
  // Scans without a pose are listed first. Then the command fails, as pcd2map does.
  Json recordings = Json::array();
  for (const std::filesystem::path& recording : recordingsIn(command.input.paths)) {
    TopicTable topics = topicsOf(recording);
    recordings.push_back(std::move(topics.json));
    if (!command.json) std::printf("%s\n", topics.text.c_str());
  }
  std::fflush(stdout);
  FindScansOptions options = findOptions(command.input);
  options.skip_without_pose = true;
  FoundScans found = [&] {
    try {
      return findScans(command.input, options);
    } catch (const std::exception&) {
      if (command.json && !recordings.empty()) printJson({{"recordings", recordings}});
      throw;
    }
  }();
  const PoseFinding finding = checkMeaning(found, command.input.meaning, impossibleConvention(command.input), 0);
  const Table table = tableOf(found.scans, detail::limitsOf(accumulateOptions(command.input, command.resolution, 1)));
  const bool would_stop = !found.without_pose.empty() && !command.input.skip_without_pose;
  for (const std::string& warning : found.scans.coordinateWarnings(command.resolution))
    found.warnings.push_back(warning);
  std::string fault = finding.fault;
  if (!finding.warning.empty()) found.warnings.push_back(finding.warning);
  if (std::string warning = warningOfSystems(found.scans); !warning.empty())
    found.warnings.push_back(std::move(warning));
  if (would_stop) {
    const std::size_t missing = found.without_pose.size(), all = found.scans.size() + missing;
    fault = (options.poses.empty() ? nameOf(found.scans) : command.input.poses) + ": " + std::to_string(missing) +
            " of " + std::to_string(all) + (all == 1 ? " scan" : " scans") + (missing == 1 ? " has" : " have") +
            " no pose, so pcd2map would stop; use --skip-without-pose to leave such scans out";
  }
  if (command.json)
    printJson(jsonOf(found, table, std::move(recordings)));
  else
    print(found, table, command.each);
  std::fflush(stdout);
  if (!fault.empty()) throw std::runtime_error(fault);
}

}  // namespace

void addScans(CLI::App& app) {
  auto options = std::make_shared<ScansCommand>();
  Command command(app, "scans", kScansHelp);
  addScanPaths(command, options->input);
  command.flag("--each", options->each, "add one line per scan: points, time and position");
  command.number("--resolution", options->resolution,
                 "side of the cells of the map [m], for the warning about coordinates that are too coarse");
  addScanOptions(command, options->input);
  command.json(options->json);
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
