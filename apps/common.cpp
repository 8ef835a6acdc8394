// SPDX-License-Identifier: BSD-3-Clause
#include "common.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <limits>

#include "gaussmap/io/pcd_reader.h"
#include "gaussmap/io/pose_doctor.h"
#include "gaussmap/io/pose_file.h"
#include "gaussmap/io/scan_list.h"

namespace gaussmap::app {

void addScanOptions(CLI::App& command, ScanInput& input) {
  command.add_option("--poses", input.poses,
                     "sensor poses in the map frame, one line a scan: TUM (t x y z qx qy qz qw), KITTI (12 numbers), or "
                     "a file name in front; default: VIEWPOINT of each file");
  command.add_option("--frame", input.frame, "frame of the points in the files")
      ->check(CLI::IsMember({"sensor", "map"}))
      ->capture_default_str();
  command.add_option("--max-range", input.max_range, "leave out points farther from the sensor [m]; 0: no limit")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

std::vector<ScanSource> findScans(const ScanInput& input) {
  const std::vector<std::filesystem::path> paths = listScans({input.paths.begin(), input.paths.end()});
  std::vector<ScanPose> poses;
  for (const std::filesystem::path& path : paths) poses.push_back(scanPose(PcdReader(path)));
  if (!input.poses.empty()) {
    const std::vector<Pose> given = posesForScans(readPoseFile(input.poses), paths);
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].pose = given[i];
  }
  const PoseDiagnosis diagnosis = diagnosePoses(poses);
  if (input.frame == "sensor")
    for (const std::string& warning : diagnosis.warnings) std::cerr << "gaussmap: warning: " << warning << '\n';
  std::vector<ScanSource> scans;
  for (const ScanPose& scan : poses) scans.push_back({scan.path, normalised(scan.pose)});
  return scans;
}

AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads) {
  return {resolution, input.frame == "map" ? ScanFrame::Map : ScanFrame::Sensor,
          input.max_range > 0.0 ? input.max_range : std::numeric_limits<double>::infinity(), threads};
}

void addThreads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads, 0 = all; the result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
}

void addOutput(CLI::App& command, Output& output, const std::string& what) {
  command.add_option("-o,--output", output.path, what)->required();
  command.add_flag("--force", output.force, "replace an existing output");
}

void checkOutput(const Output& output) {
  if (!output.force && std::filesystem::exists(output.path))
    throw UsageError(output.path + " exists already: take another name, or --force to replace it");
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

ProgressBar::ProgressBar() : on_terminal_(isatty(STDERR_FILENO) != 0), start_(now()) {}

ProgressBar::~ProgressBar() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(const AccumulateProgress& progress) {
  if (!on_terminal_) return;
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(kWidth * progress.scans_done / std::max<std::size_t>(progress.scans, 1));
  const double rate = static_cast<double>(progress.points) / std::max(now() - start_, 1e-3);
  std::fprintf(stderr, "\r\033[K[%s%s] %zu/%zu scans, %.1f M points/s, %zu cells", std::string(std::size_t(filled), '#').c_str(),
               std::string(std::size_t(kWidth - filled), '.').c_str(), progress.scans_done, progress.scans, rate / 1e6,
               progress.cells);
  std::fflush(stderr);
  shown_ = true;
}

std::string humanBytes(std::uintmax_t bytes) {
  const char* units[] = {"B", "kB", "MB", "GB", "TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 1000.0 && unit + 1 < std::size(units); ++unit) value /= 1000.0;
  char text[32];
  std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.1f %s", value, units[unit]);
  return text;
}

void addHistory(MapMetadata& metadata, const Json& step) {
  Json history = Json::array();
  const auto entry = metadata.find("history");
  if (entry != metadata.end()) {
    const Json old = Json::parse(entry->second, nullptr, false);
    if (old.is_array()) history = old;
  }
  history.push_back(step);
  metadata["history"] = history.dump();
}

Json scalesOf(const GaussianMap<3>& map) {
  Json scales = Json::array();
  for (int s = 0; s < map.scales(); ++s)
    scales.push_back({{"scale", s},
                      {"cell_side", map.grid().side(s)},
                      {"cells", map.cellCount(s)},
                      {"gaussians", map.gaussianCount(s)},
                      {"weight", map.weight(s)}});
  return scales;
}

}  // namespace gaussmap::app
