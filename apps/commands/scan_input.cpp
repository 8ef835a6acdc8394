// SPDX-License-Identifier: BSD-3-Clause
#include "commands/scan_input.h"

#include <limits>
#include <set>
#include <stdexcept>
#include <system_error>

#include "common/command.h"
#include "common/report.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/pose_checks.h"
#include "gaussmap/io/scans/pose_file.h"
#include "gaussmap/io/scans/scan_list.h"
#include "gaussmap/sensor/projection.h"

namespace gaussmap::app {

void addScanPaths(Command& command, ScanInput& input) {
  command.texts("scans", input.paths, "PCD files, or directories of them (in natural order)").required();
}

void addScanOptions(Command& command, ScanInput& input) {
  command.text("--poses", input.poses,
               "file of the sensor poses in the map frame (TUM or KITTI); default: the VIEWPOINT of each scan");
  command.choice("--frame", input.frame, {"sensor", "map"}, "frame of the points in the files");
  command.number("--max-range", input.max_range, 0.0, 1e9, "drop points farther from the sensor [m]; 0: no limit");
}

namespace {

/// For example a directory and a file in it.
void warnOfScansGivenTwice(const std::vector<std::filesystem::path>& paths) {
  std::set<std::filesystem::path> seen;
  for (const std::filesystem::path& path : paths) {
    std::error_code error;
    if (!seen.insert(std::filesystem::weakly_canonical(path, error)).second && !error)
      return warn(path.string() + " is given more than once, its points count as often");
  }
}

ScanPose lookAt(const std::filesystem::path& path) {
  const PcdReader reader(path);
  if (reader.header().find("covariance") != nullptr && reader.header().find("cell_side") != nullptr)
    throw FileError(path, "holds the Gaussians of a map, not the points of a scan");
  return scanPose(reader);
}

}  // namespace

std::vector<ScanSource> findScans(const ScanInput& input) {
  const std::vector<std::filesystem::path> paths = listScans({input.paths.begin(), input.paths.end()});
  warnOfScansGivenTwice(paths);
  std::vector<ScanPose> poses;
  poses.reserve(paths.size());
  for (const std::filesystem::path& path : paths) poses.push_back(lookAt(path));
  if (!input.poses.empty()) {
    const std::vector<Pose> given = posesForScans(readPoseFile(input.poses), paths);
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].pose = given[i];
  }
  const PoseDiagnosis diagnosis = diagnosePoses(poses);
  if (input.frame == "sensor")
    for (const std::string& warning : diagnosis.warnings) warn(warning);
  std::vector<ScanSource> scans;
  scans.reserve(poses.size());
  for (const ScanPose& scan : poses) scans.push_back({scan.path, normalised(scan.pose)});
  return scans;
}

AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads) {
  return {resolution, input.frame == "map" ? ScanFrame::Map : ScanFrame::Sensor,
          input.max_range > 0.0 ? input.max_range : std::numeric_limits<double>::infinity(), threads};
}

std::vector<Vector<3>> readPoints(const ScanInput& input, int threads) {
  const std::vector<ScanSource> scans = findScans(input);
  std::vector<Vector<3>> points = readScans(scans, accumulateOptions(input, 1.0, threads));
  if (points.empty()) throw std::runtime_error(nameOf(scans) + ": no point is usable");
  return points;
}

void sortOut(Scan& scan, const AccumulateOptions& reading, PointCounts& counts) {
  for (Eigen::Vector3d& point : scan.points) {
    const bool finite = point.allFinite(), far = finite && point.norm() > reading.max_range;
    const bool at_sensor = finite && !isReturn(point);
    ++counts.read;
    counts.non_finite += !finite;
    counts.at_sensor += at_sensor;
    counts.beyond_range += far;
    counts.accepted += finite && !far && !at_sensor;
    if (far) point.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

std::string nameOf(const std::vector<ScanSource>& scans) {
  if (scans.empty()) return "";
  const std::string more = scans.size() > 1 ? " and " + std::to_string(scans.size() - 1) + " more" : "";
  return scans.front().path.string() + more;
}

}  // namespace gaussmap::app
