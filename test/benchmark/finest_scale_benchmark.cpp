// SPDX-License-Identifier: BSD-3-Clause
// How fast is the finest scale built? gaussmap beside pcl::VoxelGridCovariance and a plain std::unordered_map, one
// thread, same points, same run. Usage: gaussmap_benchmark [--scans DIR] [--points N] [--benchmark_... options]
#include <benchmark/benchmark.h>
#include <pcl/filters/voxel_grid_covariance.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <unordered_map>

#include "gaussmap/io/pcd_reader.h"
#include "gaussmap/io/scan_list.h"
#include "gaussmap/mapping/accumulate_scans.h"
#include "gaussmap/mapping/build.h"
#include "street_scene.h"

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr cloudOf(const std::vector<gaussmap::Vector<3>>& points) {
  const Cloud::Ptr cloud(new Cloud);
  cloud->reserve(points.size());
  for (const auto& p : points)
    cloud->emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  return cloud;
}

gaussmap::MomentGrid<3> count(const Cloud& cloud, double side) {
  gaussmap::MomentGrid<3> grid(side);
  grid.addPoints(cloud.size(), [&](std::size_t i) { return cloud[i].data; });
  return grid;
}

/// The exact sums alone: what a map keeps while it grows.
void momentGrid(benchmark::State& state, const Cloud::Ptr& cloud, double side) {
  for (auto _ : state) benchmark::DoNotOptimize(count(*cloud, side).size());
}

/// The sums, the cells in key order, and the Gaussian of every cell with its eigen-decomposition, which
/// VoxelGridCovariance makes too.
void gaussianMap(benchmark::State& state, const Cloud::Ptr& cloud, double side) {
  for (auto _ : state) {
    const gaussmap::GaussianMapOctree map = gaussmap::build<3>(count(*cloud, side), {side, 2, 1, 0.0});
    double flatness = 0.0;
    for (std::size_t i = 0; i < map.gaussianCount(0); ++i)
      flatness += gaussmap::principalAxes<3>(map.localGaussian(i, 0)).flatness();
    benchmark::DoNotOptimize(flatness);
  }
}

/// The plain way: a standard hash map of double sums about the cell's centre.
void unorderedMap(benchmark::State& state, const Cloud::Ptr& cloud, double side) {
  struct Key {
    int x, y, z;
    bool operator==(const Key& o) const { return x == o.x && y == o.y && z == o.z; }
  };
  struct Hash {
    std::size_t operator()(const Key& k) const {
      return static_cast<std::size_t>(k.x) * 73856093u ^ static_cast<std::size_t>(k.y) * 19349669u ^
             static_cast<std::size_t>(k.z) * 83492791u;
    }
  };
  struct Sums {
    double n = 0.0, sum[3] = {}, product[6] = {};
  };
  const double per_side = 1.0 / side;
  for (auto _ : state) {
    std::unordered_map<Key, Sums, Hash> cells;
    for (const pcl::PointXYZ& p : *cloud) {
      const double px = static_cast<double>(p.x), py = static_cast<double>(p.y), pz = static_cast<double>(p.z);
      const Key key{static_cast<int>(std::floor(px * per_side)), static_cast<int>(std::floor(py * per_side)),
                    static_cast<int>(std::floor(pz * per_side))};
      Sums& s = cells[key];
      const double x = px - (key.x + 0.5) * side, y = py - (key.y + 0.5) * side, z = pz - (key.z + 0.5) * side;
      s.n += 1.0;
      s.sum[0] += x, s.sum[1] += y, s.sum[2] += z;
      s.product[0] += x * x, s.product[1] += x * y, s.product[2] += x * z;
      s.product[3] += y * y, s.product[4] += y * z, s.product[5] += z * z;
    }
    benchmark::DoNotOptimize(cells.size());
  }
}

void voxelGridCovariance(benchmark::State& state, const Cloud::Ptr& cloud, double side) {
  for (auto _ : state) {
    pcl::VoxelGridCovariance<pcl::PointXYZ> grid;
    grid.setInputCloud(cloud);
    const auto leaf = static_cast<float>(side);
    grid.setLeafSize(leaf, leaf, leaf);
    grid.filter(false);
    benchmark::DoNotOptimize(grid.getLeaves().size());
  }
}

/// Prints as usual and keeps the times, for the ratios at the end.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      const std::string name = run.benchmark_name();
      const bool median = name.size() > 7 && name.compare(name.size() - 7, 7, "_median") == 0;
      if (run.run_type == Run::RT_Iteration || median) times_[run.run_name.function_name] = run.GetAdjustedCPUTime();
    }
  }
  void printRatios() const {
    std::printf("\nTimes of the peers over ours (above 1: ours is faster; median CPU time where repeated)\n");
    std::printf("%-32s %24s %24s %24s\n", "input, cells", "unordered_map/MomentGrid", "VoxelGridCov./MomentGrid",
                "VoxelGridCov./Gaussians");
    for (const auto& [name, time] : times_) {
      const std::size_t slash = name.find('/');
      if (name.substr(0, slash) != "MomentGrid") continue;
      const std::string rest = name.substr(slash);
      const auto ratio = [&](const char* peer, const char* ours) {
        const auto a = times_.find(peer + rest), b = times_.find(ours + rest);
        return a == times_.end() || b == times_.end() ? 0.0 : a->second / b->second;
      };
      std::printf("%-32s %24.2f %24.2f %24.2f\n", rest.substr(1).c_str(), ratio("UnorderedMap", "MomentGrid"),
                  ratio("VoxelGridCovariance", "MomentGrid"), ratio("VoxelGridCovariance", "GaussianMap"));
    }
  }

 private:
  std::map<std::string, double> times_;
};

void registerInput(const std::string& name, const Cloud::Ptr& cloud) {
  using Body = void (*)(benchmark::State&, const Cloud::Ptr&, double);
  const std::pair<const char*, Body> bodies[] = {{"MomentGrid", momentGrid},
                                                 {"GaussianMap", gaussianMap},
                                                 {"UnorderedMap", unorderedMap},
                                                 {"VoxelGridCovariance", voxelGridCovariance}};
  for (const double side : {1.0, 0.2})
    for (const auto& [title, body] : bodies) {
      const std::string full = std::string(title) + "/" + name + "/" + (side == 1.0 ? "1m" : "0.2m");
      benchmark::RegisterBenchmark(full.c_str(), [function = body, cloud, side](benchmark::State& state) {
        function(state, cloud, side);
      })->Unit(benchmark::kMillisecond);
    }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::size_t points = 5000000;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--scans" && i + 1 < argc) {
      std::vector<gaussmap::ScanSource> scans;
      for (const auto& path : gaussmap::listScans({argv[++i]}))
        scans.push_back({path, gaussmap::normalised(gaussmap::PcdReader(path).header().viewpoint)});
      registerInput("scans", cloudOf(gaussmap::readScans(scans, {})));
    } else if (word == "--points" && i + 1 < argc) {
      points = std::strtoull(argv[++i], nullptr, 10);
    } else {
      std::fprintf(stderr, "usage: gaussmap_benchmark [--scans DIR] [--points N] [--benchmark_... options]\n");
      return 2;
    }
  }
  registerInput("street", cloudOf(gaussmap::benchmark_input::streetPoints(points)));
  RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.printRatios();
}
