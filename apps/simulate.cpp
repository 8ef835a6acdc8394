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

std::filesystem::path makeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw UsageError(folder.string() + ": the directory cannot be made: " + error.message());
  return folder;
}

std::string scanName(std::size_t number) {
  char name[32];
  std::snprintf(name, sizeof name, "scan%02zu.pcd", number);
  return name;
}

void run(const SimulateCommand& options) {
  const std::filesystem::path folder = options.output.path;
  const std::filesystem::path scans = makeFolder(folder / "scans");
  const std::vector<Pose> poses = demoTrajectory();
  const std::filesystem::path truth_path = folder / "truth.pcd";
  checkOutput({truth_path.string(), options.output.force});
  for (std::size_t i = 0; i < poses.size(); ++i) checkOutput({(scans / scanName(i)).string(), options.output.force});

  const Scene scene = demoScene();
  std::vector<Vector<3>> truth;
  std::size_t points = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const SimulatedScan scan = simulateScan(scene, poses[i], options.lidar, options.seed + i);
    writePcd(scans / scanName(i), {scan.points.begin(), scan.points.end()}, PcdPrecision::Float, scan.pose);
    truth.insert(truth.end(), scan.truth.begin(), scan.truth.end());
    points += scan.points.size();
  }
  writePcd(truth_path, truth, PcdPrecision::Double);
  std::cout << folder.string() << ": " << poses.size() << " scans, " << points
            << " points, and where their rays met the surfaces: truth.pcd\n";
}

}  // namespace

void addSimulate(CLI::App& app) {
  auto options = std::make_shared<SimulateCommand>();
  CLI::App* command =
      app.add_subcommand("simulate", "Scans of a floor, two walls and a pole, with the exact truth beside them");
  command->footer(
      "Writes DIR/scans/scan00.pcd ... (sensor frame, pose in VIEWPOINT) and DIR/truth.pcd (map frame).\n"
      "Example: gaussmap simulate -o corner && gaussmap pcd2map corner/scans -o corner.gmap");
  addOutput(*command, options->output, "directory to write to");
  command->add_option("--noise", options->lidar.noise, "standard deviation of the ranges [m]")
      ->check(numberBetween(0.0, 1e3))
      ->capture_default_str();
  command->add_option("--rings", options->lidar.rings, "lasers of the lidar")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--columns", options->lidar.columns, "directions in a turn")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  addSeed(*command, options->seed, "of the noise");
  command->callback([options] { run(*options); });
}

}  // namespace gaussmap::app
