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

/// Distance of the points on a true surface [m]: a fifth of a finest cell.
inline constexpr double kTruthSpacing = 0.02;

struct LoadedData {
  std::vector<Vector<3>> points;  // points of the map [m]
  std::vector<Vector<3>> truth;   // the reference for samples of the map [m]
  std::vector<Vector<3>> hits;    // simulated: the points where rays met the surface [m]; otherwise empty
  TriangleMesh mesh;              // simulated: the whole surface; otherwise empty
};

struct DataSet {
  std::string name;
  std::string truth;  // description of the truth
  MapOptions options;
  std::vector<double> budgets;  // multiples of the number of cells of the coarsest scale
  bool simulated = false;
  std::function<LoadedData(std::uint64_t seed)> load;
};

/// Returns all points of a simulated drive [m, map frame].
LoadedData simulatedDrive(const Simulation& simulation, std::uint64_t seed);

/// Returns the simulated street and avenue with `scans` scans each (0: all their scans). If `data` names a folder, also
/// returns one outdoor scan, one RGB-D image and one building. `spacing`: of the points on the simulated surface [m].
std::vector<DataSet> dataSets(const std::filesystem::path& data, int scans, double spacing = kTruthSpacing);

}  // namespace gaussmap::refinement
