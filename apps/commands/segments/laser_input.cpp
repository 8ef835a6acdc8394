// SPDX-License-Identifier: BSD-3-Clause
#include "commands/segments/laser_input.h"

#include <algorithm>
#include <limits>

#include "commands/planar_input.h"
#include "common/command.h"
#include "common/report.h"

#include "gaussmap/io/logs/carmen_log.h"
#include "gaussmap/segments/laser_scan.h"
#include "io/logs/carmen_scans.h"

namespace gaussmap::app {
namespace {

LaserScans readLogs(const std::vector<std::string>& paths) {
  LaserScans all;
  for (const std::string& path : paths) {
    const CarmenLog log = readCarmenLog(path);
    for (const std::string& warning : detail::warningsOf(log)) warn(path + ": " + warning);
    for (std::size_t i = 0; i < log.scans.size(); ++i) {
      all.scans.push_back(log.scans[i]);
      all.names.push_back(std::filesystem::path(path).filename().string() + ":" + std::to_string(i));
    }
    all.files.emplace_back(path);
  }
  return all;
}

LaserScans readPcds(const LaserInput& input) {
  const PlanarScanOptions options =
      planarOptions(input.slice, accumulateOptions(input.scans, MapOptions().resolution, 0));
  LaserScans all;
  const FileScans scans = openScans(input.scans, 0);
  all.scans = planarScans(scans, options);
  warnOfCoordinates(scans, MapOptions().resolution);
  for (const FileScan& scan : scans.files()) {
    all.files.push_back(scan.path);
  }
  all.names = shortNamesOf(scans);
  return all;
}

}  // namespace

void addLaserOptions(Command& command, LaserInput& input) {
  command
      .texts("scans", input.scans.paths,
             "CARMEN logs (.log, .log.gz), or scans of a planar laser (PCD, recordings of ROS ...), or directories of "
             "them")
      .required();
  command.files({"scans"}, {".log", ".log.gz", ".pcd", ".pcd.gz"});
  addScanOptions(command, input.scans);
  command.numbers("--slice", input.slice, 2, -1e6, 1e6,
                  "use only points of 3-D scans between these two heights in the map frame [m]");
  command.number("--position-noise", input.position_noise, 0.0, 100.0, "standard deviation of the poses' x and y [m]")
      .rare();
  command.number("--heading-noise", input.heading_noise, 0.0, 1.0, "standard deviation of the poses' heading [rad]")
      .rare();
}

LaserScans readLaserScans(const LaserInput& input) {
  const std::vector<std::string>& paths = input.scans.paths;
  const auto logs =
      std::count_if(paths.begin(), paths.end(), [](const std::string& path) { return isCarmenLogName(path); });
  const bool are_logs = logs > 0;
  if (are_logs && static_cast<std::size_t>(logs) < paths.size())
    throw UsageError("logs and PCD scans cannot be mixed; use only one kind per map");
  if (are_logs && (!input.slice.empty() || !input.scans.poses.empty() || input.scans.frame != "sensor"))
    throw UsageError(
        "--slice, --poses and --frame: only for PCD scans, because a log contains planar scans with their poses");
  if (are_logs && !input.scans.crop.empty()) throw UsageError("--crop: only for PCD scans");
  LaserScans all = are_logs ? readLogs(paths) : readPcds(input);
  for (LaserScan& scan : all.scans) {
    if (are_logs && input.scans.max_range > 0.0) scan.max_range = std::min(scan.max_range, input.scans.max_range);
    for (double& range : scan.ranges)
      if (are_logs && range < input.scans.min_range) range = std::numeric_limits<double>::quiet_NaN();
    const double square = input.position_noise * input.position_noise;
    scan.pose.covariance.diagonal() << square, square, input.heading_noise * input.heading_noise;
  }
  return all;
}

}  // namespace gaussmap::app
