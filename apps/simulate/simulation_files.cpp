// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulation_files.h"

#include <algorithm>
#include <cstdint>
#include <string>

#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/scans/scan_names.h"

namespace gaussmap::app {
using namespace detail;

namespace {

/// Returns names whose alphabetical order is the order of the numbers.
std::vector<std::filesystem::path> scanPaths(const std::filesystem::path& folder, std::size_t count) {
  const std::size_t digits = std::max<std::size_t>(2, std::to_string(count - 1).size());
  std::vector<std::filesystem::path> paths;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number = std::to_string(i);
    paths.push_back(folder / ("scan" + std::string(digits - number.size(), '0') + number + ".pcd"));
  }
  return paths;
}

void refuseOtherScans(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& own) {
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (!scanExtension(entry.path().filename()).empty() && std::find(own.begin(), own.end(), entry.path()) == own.end())
      throw UsageError(entry.path().string() + " would lie among the new scans; remove it or choose another directory");
}

}  // namespace

SimulationFiles prepareFiles(const Output& output, std::size_t scans, bool with_walls) {
  const std::filesystem::path folder = output.path, scan_folder = folder / "scans";
  makeFolder(scan_folder);
  SimulationFiles files{scanPaths(scan_folder, scans), folder / "truth.pcd", folder / "truth.ply",
                        folder / "trajectory.tum", with_walls ? folder / "walls.pcd" : std::filesystem::path()};
  std::vector<std::filesystem::path> all = {files.truth_points, files.truth_mesh, files.trajectory};
  if (with_walls) all.push_back(files.walls);
  all.insert(all.end(), files.scans.begin(), files.scans.end());
  for (const std::filesystem::path& path : all) checkOutput({path.string(), output.force});
  refuseOtherScans(scan_folder, files.scans);
  return files;
}

void writeScan(const std::filesystem::path& path, const SimulatedScan& scan, bool with_labels) {
  std::vector<float> xyz;
  xyz.reserve(3 * scan.points.size());
  for (const Eigen::Vector3d& point : scan.points)
    for (int axis = 0; axis < 3; ++axis) xyz.push_back(static_cast<float>(point(axis)));
  std::vector<std::uint32_t> labels;
  for (const SurfaceLabel label : scan.labels) labels.push_back(static_cast<std::uint32_t>(label));
  std::vector<PcdOutput> fields;
  const char* const names[] = {"x", "y", "z"};
  for (std::size_t axis = 0; axis < 3; ++axis)
    fields.push_back(pcdOutput(names[axis], xyz.data() + (xyz.empty() ? 0 : axis), 1, 3 * sizeof(float)));
  if (with_labels) fields.push_back(pcdOutput("label", labels.data()));
  writePcd(path, scan.points.size(), fields, scan.pose);
}

SegmentMap planMap() {
  SegmentMap map;
  for (const WallSegment& wall : planWalls()) {
    const std::size_t i = map.segments.size();
    Segment segment;
    segment.start = wall.from;
    segment.end = wall.to;
    if (i == 0 || segment.start != map.segments.back().end) map.chains.push_back({i, i, false});
    map.segments.push_back(segment);
    SegmentMap::Chain& chain = map.chains.back();
    chain.last = i + 1;
    chain.closed = map.segments[chain.first].start == segment.end;
  }
  return map;
}

}  // namespace gaussmap::app
