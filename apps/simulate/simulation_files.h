// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "common/usage.h"
#include "gaussmap/segments/segment_map.h"
#include "simulation/simulation.h"

namespace gaussmap::app {

/// The paths of the files of a simulation.
struct SimulationFiles {
  std::vector<std::filesystem::path> scans;  // scan00.pcd ...: all numbers have as many digits as the last one
  std::filesystem::path truth_points, truth_mesh, trajectory;
  std::filesystem::path walls;  // empty for scenes without a floor plan
};

/// Creates the folders and returns the paths of the files. Throws UsageError if a file exists and may not be replaced,
/// or if the folder of the scans contains other scans, which would later be read together with the new ones.
SimulationFiles prepareFiles(const Output& folder, std::size_t scans, bool with_walls);

/// Writes a scan as PCD: points in the sensor frame, the pose as VIEWPOINT, and, with `with_labels`, a field "label"
/// that is 1 on moving objects.
void writeScan(const std::filesystem::path& path, const SimulatedScan& scan, bool with_labels);

/// Returns the walls of the scene "plan" as segments. Two consecutive walls are linked if the second one begins at the
/// end of the first one.
SegmentMap planMap();

}  // namespace gaussmap::app
