// SPDX-License-Identifier: BSD-3-Clause
#include "commands/scan_input.h"

#include <stdexcept>
#include <utility>

#include "common/box.h"
#include "common/command.h"
#include "common/report.h"

namespace gaussmap::app {

void addScanPaths(Command& command, ScanInput& input) {
  command.texts("scans", input.paths, "PCD files, or directories of PCD files (in natural order)").required();
  command.files({"scans"}, {".pcd", ".pcd.gz"});
}

void addScanOptions(Command& command, ScanInput& input) {
  command.text("--poses", input.poses,
               "file with the sensor poses in the map frame (TUM or KITTI); default: the VIEWPOINT of each scan");
  command.choice("--frame", input.frame, {"sensor", "map"}, "frame of the points in the files");
  addRangeOptions(command, input);
  command.numbers("--crop", input.crop, 4, 6, -1e12, 1e12,
                  "use only points in this box of the map frame: x0 y0 x1 y1, or x0 y0 z0 x1 y1 z1 [m]");
  command.files({"--poses"});
}

void addRangeOptions(Command& command, ScanInput& input) {
  command.number("--max-range", input.max_range, 0.0, 1e9,
                 "drop points farther from the sensor than this [m]; 0 = no limit");
  command.number("--min-range", input.min_range, 0.0, 1e9,
                 "drop points nearer to the sensor than this [m], for example the robot itself");
}

PcdScans openScans(const ScanInput& input) {
  FoundScans found = findScans({input.paths.begin(), input.paths.end()}, input.poses,
                               input.frame == "map" ? ScanFrame::Map : ScanFrame::Sensor);
  for (const std::string& warning : found.warnings) warn(warning);
  return std::move(found.scans);
}

AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads) {
  AccumulateOptions options;
  options.resolution = resolution;
  options.threads = threads;
  if (input.max_range > 0.0) options.max_range = input.max_range;
  options.min_range = input.min_range;
  if (options.min_range > options.max_range) throw UsageError("--min-range: must not be above --max-range");
  if (!input.crop.empty()) options.crop = boxOf("--crop", input.crop);
  return options;
}

void warnOfCoordinates(const PcdScans& scans, double resolution) {
  for (const std::string& warning : scans.coordinateWarnings(resolution)) warn(warning);
}

std::vector<Vector<3>> readPoints(const ScanInput& input, int threads, double resolution) {
  const PcdScans scans = openScans(input);
  std::vector<Vector<3>> points = gaussmap::readPoints(scans, accumulateOptions(input, 1.0, threads));
  warnOfCoordinates(scans, resolution);
  if (points.empty()) throw std::runtime_error(nameOf(scans) + ": no point is usable");
  return points;
}

std::string nameOf(const Scans& scans) {
  if (scans.size() == 0) return "";
  const std::string more = scans.size() > 1 ? " and " + std::to_string(scans.size() - 1) + " more" : "";
  return scans.info(0).name + more;
}

}  // namespace gaussmap::app
