// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "clock.h"
#include "gaussmap/io/scans/file_scans.h"
#include "simulation/simulation.h"

namespace gaussmap::benchmark {

struct NamedCloud {
  std::string name;
  pcl::PointCloud<pcl::PointXYZ>::Ptr cloud;
};

/// Returns one cloud per path: the PCD file, or the first scan of the directory. Without paths, returns the first scan
/// of the simulated street.
inline std::vector<NamedCloud> loadClouds(const std::vector<std::string>& paths) {
  std::vector<NamedCloud> clouds;
  for (const std::string& path : paths) {
    const std::filesystem::path file =
        std::filesystem::is_directory(path) ? listScans({path}).at(0) : std::filesystem::path(path);
    auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    if (pcl::io::loadPCDFile(file.string(), *cloud) != 0) throw std::runtime_error(file.string() + ": cannot be read");
    clouds.push_back({file.parent_path().filename() / file.filename(), cloud});
  }
  if (!paths.empty()) return clouds;
  const Simulation street = makeSimulation(WorldName::Street, {1, false});
  const SimulatedScan scan = simulateScan(street, 0);
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const auto& p : scan.points) cloud->emplace_back(float(p.x()), float(p.y()), float(p.z()));
  return {{"street, simulated", cloud}};
}

/// Returns the minimum processor time of some runs [s], summed over all threads. Other programs on the machine do not
/// count.
template <typename Run>
double minSeconds(int runs, const Run& run) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs; ++i) {
    const double start = processorSeconds();
    run();
    least = std::min(least, processorSeconds() - start);
  }
  return least;
}

}  // namespace gaussmap::benchmark
