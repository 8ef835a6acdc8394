// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark --table: gaussmap beside its peers, measured in the same run, each in a process of its own.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <random>

#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/pcd_scans.h"
#include "gaussmap/mapping/accumulate_scans.h"
#include "parts.h"
#include "street_scene.h"

namespace gaussmap::benchmark {

Cloud::Ptr cloudOf(const std::vector<Vector<3>>& points) {
  const Cloud::Ptr cloud(new Cloud);
  cloud->reserve(points.size());
  for (const auto& p : points)
    cloud->emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  return cloud;
}

namespace {

Cloud::Ptr scansIn(const std::filesystem::path& folder) {
  std::vector<PcdScan> scans;
  for (const auto& path : listScans({folder})) scans.push_back({path, normalised(PcdReader(path).header().viewpoint)});
  return cloudOf(readPoints(PcdScans(scans), {}));
}

Cloud::Ptr shuffled(const Cloud& cloud) {
  Cloud::Ptr copy(new Cloud(cloud));
  std::shuffle(copy->points.begin(), copy->points.end(), std::mt19937_64(1));
  return copy;
}

void fill(const Options& options, const std::filesystem::path& work, Table& table) {
  measureMachine(options.runs, table);
  if (!options.data.empty())
    measureBuilding({"kitti_6scans", scansIn(std::filesystem::path(options.data) / "kitti_6scans")}, options.runs,
                    false, table);
  for (const std::size_t count : options.points) {
    const Input packets{"street, packets", cloudOf(benchmark_input::streetPoints(count, 0, 1))};
    const int runs = count > 10000000 ? std::min(options.runs, 3) : options.runs;
    const bool is_goal = count == options.points.front();
    measureBuilding(packets, runs, is_goal, table);
    measureBuilding({"street, shuffled", shuffled(*packets.cloud)}, runs, is_goal, table);
    if (!is_goal) continue;
    measureCoarsening(packets, options.runs, table);
    measureReading(*packets.cloud, work, options.runs, table);
  }
  measureHausdorff(std::min<std::size_t>(options.points.front(), 1000000), options.runs, table);
  measureOnline(options, table);
  measureCommands(options, work, table);
}

/// A directory of our own that goes with us.
struct WorkDirectory {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "gaussmap_benchmark_XXXXXX";
  WorkDirectory() {
    std::string name = path;
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be made");
    path = name;
  }
  ~WorkDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

}  // namespace
}  // namespace gaussmap::benchmark

int main(int argc, char** argv) try {
  using namespace gaussmap::benchmark;
  CLI::App app("gaussmap beside its peers");
  Options options;
  options.build = std::filesystem::canonical("/proc/self/exe").parent_path().parent_path().parent_path();
  bool is_table = false;
  bool is_growth = false;
  std::vector<std::size_t> growth = {1000000, 5000000, 20000000, 80000000};
  std::string json;
  app.add_flag("--table", is_table, "everything, beside the peers");
  app.add_flag("--growth", is_growth, "time and memory against points and cells, fitted");
  app.add_option("--growth-points", growth, "numbers of points for it")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--points", options.points, "of the simulated drive; goals are those of the first number")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--data", options.data, "directory with kitti_6scans, rgbd_office_single, carmen_intel, ...")
      ->check(CLI::ExistingDirectory);
  app.add_option("--runs", options.runs, "the fastest counts")->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--json", json, "write the figures for machines");
  CLI11_PARSE(app, argc, argv);
  if (!is_table && !is_growth) {
    std::fprintf(stderr, "gaussmap_benchmark: --table or --growth\n");
    return 2;
  }
  const WorkDirectory work;
  Table table;
  if (is_table) {
    fill(options, work.path, table);
    runOthers(options, work.path, table);
  }
  if (is_growth) measureGrowth(growth, table);
  if (!json.empty()) writeJson(json, table);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "gaussmap_benchmark: %s\n", error.what());
  return 1;
}
