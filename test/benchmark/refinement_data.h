// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gaussmap/map/grid.h"
#include "gaussmap/mesh/triangle_mesh.h"
#include "simulation/simulation.h"

namespace gaussmap::refinement {

struct LoadedData {
  std::vector<Vector<3>> points;  // what the map is made of [m]
  std::vector<Vector<3>> truth;   // what its samples are measured against [m]
  std::vector<Vector<3>> hits;    // simulated: where the rays met the surface [m]; else empty
  TriangleMesh mesh;              // simulated: the whole surface; else empty
};

struct DataSet {
  std::string name;
  std::string truth;  // in words
  MapOptions options;
  std::vector<double> budgets;  // multiples of the coarsest scale's cells
  bool simulated = false;
  std::function<LoadedData(std::uint64_t seed)> load;
};

/// All points of a simulated drive [m, map frame].
LoadedData simulatedDrive(const Simulation& simulation, std::uint64_t seed);

/// The simulated street and avenue with `scans` scans each (0: as many as they have). If `data` names a folder: also
/// one outdoor scan, one RGB-D image and one building.
std::vector<DataSet> dataSets(const std::filesystem::path& data, int scans);

}  // namespace gaussmap::refinement
