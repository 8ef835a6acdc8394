// SPDX-License-Identifier: BSD-3-Clause
// gaussmap simulate -o DIR: scans of a built-in scene whose surfaces are known exactly.
#include <cstdio>
#include <iostream>

#include "common.h"
#include "gaussmap/io/pcd_writer.h"
#include "gaussmap/simulation/lidar.h"
#include "gaussmap/simulation/scene.h"

namespace gaussmap::app {
namespace {

struct SimulateCommand {
  Output output;
  LidarOptions lidar;
  std::uint64_t seed = 1;
};

void run(const SimulateCommand& options) {
  const std::filesystem::path folder = options.output.path;
  const auto target = [&](const std::string& name) {
    checkOutput({(folder / name).string(), options.output.force});
    return folder / name;
  };
  std::filesystem::create_directories(folder / "scans");
  const Scene scene = demoScene();
  std::vector<Vector<3>> truth;
  std::size_t number = 0, points = 0;
  for (const Pose& pose : demoTrajectory()) {
    char name[32];
    std::snprintf(name, sizeof name, "scans/scan%02zu.pcd", number);
    const SimulatedScan scan = simulateScan(scene, pose, options.lidar, options.seed + number++);
    writePcd(target(name), {scan.points.begin(), scan.points.end()}, PcdPrecision::Float, scan.pose);
    truth.insert(truth.end(), scan.truth.begin(), scan.truth.end());
    points += scan.points.size();
  }
  writePcd(target("truth.pcd"), truth, PcdPrecision::Double);
  std::cout << folder.string() << ": " << number << " scans, " << points
            << " points, and where their rays met the surfaces: truth.pcd\n";
}

}  // namespace

void addSimulate(CLI::App& app) {
  auto options = std::make_shared<SimulateCommand>();
  CLI::App* command =
      app.add_subcommand("simulate", "Scans of a floor, two walls and a pole, with the exact truth beside them");
  command->footer("Writes DIR/scans/scan00.pcd ... (sensor frame, pose in VIEWPOINT) and DIR/truth.pcd (map frame).\n"
                  "Example: gaussmap simulate -o corner && gaussmap pcd2map corner/scans -o corner.gmap");
  addOutput(*command, options->output, "directory to write to");
  command->add_option("--noise", options->lidar.noise, "standard deviation of the ranges [m]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--rings", options->lidar.rings, "lasers of the lidar")->check(CLI::Range(1, 1000))->capture_default_str();
  command->add_option("--columns", options->lidar.columns, "directions in a turn")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the noise")->capture_default_str();
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
