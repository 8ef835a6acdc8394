// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "common/usage.h"
#include "gaussmap/segments/segment_map.h"
#include "simulation/simulation.h"

namespace gaussmap::app {

/// The files of a simulation in a folder.
struct SimulationFiles {
  std::vector<std::filesystem::path> scans;  // scan00.pcd ..., with as many digits as the last one needs
  std::filesystem::path truth_points, truth_mesh, trajectory;
  std::filesystem::path walls;  // empty if there are none
};

/// Makes the folders. Throws UsageError if a file exists and may not be replaced, or if the folder of the scans holds
/// other scans, which would be taken for scans of this simulation.
SimulationFiles prepareFiles(const Output& folder, std::size_t scans, bool with_walls);

/// Points in the sensor frame, the pose in VIEWPOINT; `with_labels`: and a field "label", 1 on moving objects.
void writeScan(const std::filesystem::path& path, const SimulatedScan& scan, bool with_labels);

/// The walls of the scene "plan", linked where one begins at the end of the one before.
SegmentMap planMap();

}  // namespace gaussmap::app
