// SPDX-License-Identifier: BSD-3-Clause
// gaussmap simulate [SCENE] -o DIR: simulates scans of a built-in world and writes its exact surfaces.
#include "simulation/simulation.h"

#include <iostream>
#include <map>
#include <memory>

#include "commands/commands.h"
#include "common/command.h"
#include "gaussmap/io/export/segment_files.h"
#include "gaussmap/io/mesh/ply.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "simulate/simulation_files.h"

namespace gaussmap::app {
using namespace detail;

namespace {

const Help kSimulateHelp = {
    "Simulate scans of a built-in scene, with exact ground truth",
    "gaussmap simulate street -o street --moving && gaussmap pcd2map street/scans -o street.gmap",
    R"(Scenes:
  corner  a floor, two walls and a pole
  street  150 m of a street with plane fronts, trees, poles, parked cars and a fence
  avenue  the same street with fronts in relief and many trees
  hall    a hall, a corridor and furnished rooms
  plan    a floor plan with walls of 12 cm, for a planar laser

Files in the output directory:
  scans/scan00.pcd ...  points in the sensor frame, pose in VIEWPOINT; --moving adds a field label (1 = moving object)
  truth.ply             static surfaces, in the map frame: the triangles that the rays are cast against
  truth.pcd             points where the rays hit static surfaces, without noise, in the map frame
  trajectory.tum        poses of the scans
  walls.pcd             only for plan: the walls, as a map of segments)"};

const std::map<std::string, WorldName> kWorlds = {{"corner", WorldName::Corner},
                                                  {"street", WorldName::Street},
                                                  {"avenue", WorldName::Avenue},
                                                  {"hall", WorldName::Hall},
                                                  {"plan", WorldName::Plan}};

struct SimulateCommand {
  std::string scene = "corner";
  Output output;
  SimulationOptions world;
  double noise = LidarOptions().noise;
  std::optional<int> rings, columns;
  std::optional<double> field, max_range;
  int threads = 0;
  std::uint64_t seed = 1;
};

void adapt(LidarOptions& lidar, const SimulateCommand& options) {
  if (options.field) throw UsageError("--field-of-view: only the planar laser of 'plan' has this option");
  lidar.rings = options.rings.value_or(lidar.rings);
  lidar.columns = options.columns.value_or(lidar.columns);
}

void adapt(PlanarLaserOptions& laser, const SimulateCommand& options) {
  if (options.rings) throw UsageError("--rings: the planar laser of 'plan' has only one ring");
  laser.beams = options.columns.value_or(laser.beams);
  laser.field_deg = options.field.value_or(laser.field_deg);
}

Simulation simulationOf(const SimulateCommand& options) {
  if (options.world.moving && options.scene != "street" && options.scene != "avenue")
    throw UsageError("--moving: only the scenes 'street' and 'avenue' have moving objects");
  Simulation simulation = makeSimulation(kWorlds.at(options.scene), options.world);
  std::visit(
      [&](auto& sensor) {
        adapt(sensor, options);
        sensor.noise = options.noise;
        sensor.max_range = options.max_range.value_or(sensor.max_range);
        sensor.threads = options.threads;
      },
      simulation.sensor);
  return simulation;
}

void run(const SimulateCommand& options) {
  const Simulation simulation = simulationOf(options);
  const SimulationFiles files = prepareFiles(options.output, simulation.trajectory.size(), options.scene == "plan");
  std::vector<Vector<3>> truth;
  std::size_t points = 0;
  for (std::size_t i = 0; i < files.scans.size(); ++i) {
    const SimulatedScan scan = simulateScan(simulation, i, options.seed);
    writeScan(files.scans[i], scan, options.world.moving);
    for (std::size_t j = 0; j < scan.truth.size(); ++j)
      if (scan.labels[j] == SurfaceLabel::Static) truth.push_back(scan.truth[j]);
    points += scan.points.size();
  }
  writePcd(files.truth_points, truth, PcdPrecision::Double);
  writePly(files.truth_mesh, simulation.world.mesh());
  writeTum(files.trajectory, simulation.trajectory);
  if (!files.walls.empty()) saveSegmentsPcd(files.walls, planMap());
  std::cout << options.output.path << ": " << options.scene << ", " << files.scans.size()
            << (files.scans.size() == 1 ? " scan, " : " scans, ") << points << " points";
  if (options.world.moving) std::cout << " (" << points - truth.size() << " on moving objects)";
  std::cout << "; the truth: truth.ply (" << simulation.world.mesh().triangles.size()
            << " triangles), truth.pcd (where rays met them), trajectory.tum"
            << (files.walls.empty() ? "\n" : ", walls.pcd (for gaussmap segments --walls)\n");
}

}  // namespace

void addSimulate(CLI::App& app) {
  auto options = std::make_shared<SimulateCommand>();
  Command command(app, "simulate", kSimulateHelp);
  command.choice("scene", options->scene, Command::wordsOf(kWorlds), "scene to scan");
  command.output(options->output, "directory to write to");
  command
      .number("--scans", options->world.scans, 1, 100000,
              "number of scans along the path; default: 5 to 240, depending on the scene")
      .hideDefault();
  command.flag("--moving", options->world.moving,
               "add three driving cars and two walking pedestrians (street, avenue)");
  command.number("--noise", options->noise, 0.0, 1e3, "standard deviation of the ranges [m]");
  command.number("--rings", options->rings, 1, 1000, "rings of the lidar; default: 32, street 64");
  command.number("--columns", options->columns, 1, 100000,
                 "directions per turn, or beams of the planar laser; default: 1800, plan 361");
  command.number("--field-of-view", options->field, 1.0, 360.0,
                 "field of view of the planar laser [degree]; default: 180");
  command.number("--max-range", options->max_range, 1e-3, 1e9,
                 "maximum range of the sensor [m]; default: 60, street 80, plan 30");
  command.seed(options->seed, "seed of the noise");
  command.threads(options->threads);
  command.folders({"--output"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
