// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "table.h"

namespace gaussmap::benchmark {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// A cloud that all methods are measured on.
struct Input {
  std::string name;
  Cloud::Ptr cloud;
};

Cloud::Ptr cloudOf(const std::vector<Vector<3>>& points);

struct Options {
  std::vector<std::size_t> points = {5000000, 20000000};  ///< of the simulated drive
  std::string data;                                       ///< directory with kitti_6scans and so on; may be empty
  std::string build;                                      ///< build directory, with apps/gaussmap
  int runs = 5;                                           ///< the fastest counts; at most 3 for over 10 M points
};

/// The speed-up of two threads of this machine, for work without shared data.
void measureMachine(int runs, Table& table);
/// The finest scale beside pcl::VoxelGridCovariance, std::unordered_map and OctoMap's hits: time, memory.
void measureBuilding(const Input& input, int runs, Table& table);
/// The share of the coarser scales in the time of a build.
void measureCoarsening(const Input& input, int runs, Table& table);
/// PCD files beside pcl::io::loadPCDFile.
void measureReading(const Cloud& cloud, const std::filesystem::path& work, int runs, Table& table);
/// Distances of two clouds beside pcl::KdTreeFLANN.
void measureHausdorff(std::size_t points, int runs, Table& table);
/// Scan by scan beside OctoMap with rays.
void measureOnline(const Options& options, Table& table);
/// Whole commands beside pcl-tools; does nothing if these are not installed.
void measureCommands(const Options& options, const std::filesystem::path& work, Table& table);
/// The figures of other subcommands: refinement-speed, registration, normals, segments.
void runOthers(const Options& options, const std::filesystem::path& work, Table& table);
/// Time and memory against numbers of points and cells, fitted.
void measureGrowth(const std::vector<std::size_t>& points, Table& table);

}  // namespace gaussmap::benchmark
