// SPDX-License-Identifier: BSD-3-Clause
#include "commands/scan_input.h"

#include <limits>
#include <stdexcept>
#include <utility>

#include "commands/sensor_positions.h"
#include "common/command.h"
#include "common/report.h"

namespace gaussmap::app {

void addScanPaths(Command& command, ScanInput& input) {
  command.texts("scans", input.paths, "PCD files, or directories of PCD files (in natural order)").required();
  command.files({"scans"}, {".pcd"});
}

void addScanOptions(Command& command, ScanInput& input) {
  command.text("--poses", input.poses,
               "file with the sensor poses in the map frame (TUM or KITTI); default: the VIEWPOINT of each scan");
  command.choice("--frame", input.frame, {"sensor", "map"}, "frame of the points in the files");
  command.number("--max-range", input.max_range, 0.0, 1e9,
                 "drop points farther from the sensor than this [m]; 0 = no limit");
  command.files({"--poses"});
}

PcdScans openScans(const ScanInput& input, const char* follows_rays) {
  FoundScans found = findScans({input.paths.begin(), input.paths.end()}, input.poses,
                               input.frame == "map" ? ScanFrame::Map : ScanFrame::Sensor);
  if (follows_rays) requireSensorPositions(found.scans, follows_rays);
  for (const std::string& warning : found.warnings) warn(warning);
  return std::move(found.scans);
}

AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads) {
  return {resolution, input.max_range > 0.0 ? input.max_range : std::numeric_limits<double>::infinity(), threads};
}

std::vector<Vector<3>> readPoints(const ScanInput& input, int threads) {
  const PcdScans scans = openScans(input);
  std::vector<Vector<3>> points = gaussmap::readPoints(scans, accumulateOptions(input, 1.0, threads));
  if (points.empty()) throw std::runtime_error(nameOf(scans) + ": no point is usable");
  return points;
}

std::string nameOf(const Scans& scans) {
  if (scans.size() == 0) return "";
  const std::string more = scans.size() > 1 ? " and " + std::to_string(scans.size() - 1) + " more" : "";
  return scans.info(0).name + more;
}

}  // namespace gaussmap::app
