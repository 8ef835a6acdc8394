// SPDX-License-Identifier: BSD-3-Clause
// gaussmap_benchmark table: compares gaussmap with its peers in the same run, each in its own process.
// gaussmap_benchmark growth: measures time and memory against the numbers of points and cells.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>

#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"
#include "io/files/temporary_directory.h"
#include "parts.h"
#include "street_points.h"
#include "subcommands.h"

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
  std::vector<FileScan> scans;
  for (const auto& path : listScans({folder})) scans.push_back({path, normalised(PcdReader(path).header().viewpoint)});
  return cloudOf(readPoints(FileScans(scans), {}));
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
                    table);
  for (const std::size_t count : options.points) {
    const Input packets{"street, packets", cloudOf(streetPoints(count, 0, 1))};
    const int runs = count > 10000000 ? std::min(options.runs, 3) : options.runs;
    measureBuilding(packets, runs, table);
    measureBuilding({"street, shuffled", shuffled(*packets.cloud)}, runs, table);
    if (count != options.points.front()) continue;
    measureCoarsening(packets, options.runs, table);
    measureReading(*packets.cloud, work, options.runs, table);
  }
  measureHausdorff(std::min<std::size_t>(options.points.front(), 1000000), options.runs, table);
  measureOnline(options, table);
  measureCommands(options, work, table);
}

void addGrowthPoints(CLI::App& command, const char* name, std::vector<std::size_t>& points) {
  points = {1000000, 5000000, 20000000, 80000000};
  command.add_option(name, points, "numbers of points of growth")->check(CLI::PositiveNumber)->capture_default_str();
}

}  // namespace

void addTable(CLI::App& app) {
  struct Given : Options {
    bool growth = false;
    std::vector<std::size_t> growth_points;
    std::string json;
  };
  const auto given = std::make_shared<Given>();
  given->build = std::filesystem::canonical("/proc/self/exe").parent_path().parent_path().parent_path();
  CLI::App& command = *app.add_subcommand("table", "gaussmap beside its peers");
  command.add_flag("--growth", given->growth, "measure the growth too");
  addGrowthPoints(command, "--growth-points", given->growth_points);
  command
      .add_option("--points", given->points,
                  "numbers of points of the simulated drive; the first one for all other inputs")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--data", given->data, "directory with kitti_6scans, rgbd_office_single, carmen_intel, ...")
      ->check(CLI::ExistingDirectory);
  command.add_option("--runs", given->runs, "the fastest counts")->check(CLI::Range(1, 1000))->capture_default_str();
  command.add_option("--json", given->json, "write the figures for machines");
  command.callback([given] {
    const test::TemporaryDirectory work;
    Table table;
    fill(*given, work.path(), table);
    runOthers(*given, work.path(), table);
    if (given->growth) measureGrowth(given->growth_points, table);
    if (!given->json.empty()) writeJson(given->json, table);
  });
}

void addGrowth(CLI::App& app) {
  struct Given {
    std::vector<std::size_t> points;
    std::string json;
  };
  const auto given = std::make_shared<Given>();
  CLI::App& command = *app.add_subcommand("growth", "time and memory against points and cells, fitted");
  addGrowthPoints(command, "--points", given->points);
  command.add_option("--json", given->json, "write the figures for machines");
  command.callback([given] {
    Table table;
    measureGrowth(given->points, table);
    if (!given->json.empty()) writeJson(given->json, table);
  });
}

}  // namespace gaussmap::benchmark
