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
  std::vector<std::size_t> points = {5000000, 20000000};  ///< sizes of the simulated drive
  std::string data;                                       ///< directory with kitti_6scans and so on; may be empty
  std::string build;                                      ///< build directory, with apps/gaussmap
  int runs = 5;                                           ///< the fastest one counts; at most 3 above 10 M points
};

/// Measures the speed-up of two threads on this machine, for work without shared data.
void measureMachine(int runs, Table& table);
/// Measures time and memory of the finest scale beside pcl::VoxelGridCovariance, std::unordered_map and OctoMap (hits
/// only).
void measureBuilding(const Input& input, int runs, Table& table);
/// Measures the share of the coarser scales in the time of a build.
void measureCoarsening(const Input& input, int runs, Table& table);
/// Measures the reading of PCD files beside pcl::io::loadPCDFile.
void measureReading(const Cloud& cloud, const std::filesystem::path& work, int runs, Table& table);
/// Measures the distances between two clouds beside pcl::KdTreeFLANN.
void measureHausdorff(std::size_t points, int runs, Table& table);
/// Measures on-line mapping beside OctoMap with rays.
void measureOnline(const Options& options, Table& table);
/// Measures whole commands beside pcl-tools. Does nothing if pcl-tools is not installed.
void measureCommands(const Options& options, const std::filesystem::path& work, Table& table);
/// Adds the figures of other subcommands: refinement-speed, registration, normals, segments.
void runOthers(const Options& options, const std::filesystem::path& work, Table& table);
/// Fits time and memory to the numbers of points and cells.
void measureGrowth(const std::vector<std::size_t>& points, Table& table);

}  // namespace gaussmap::benchmark
