// SPDX-License-Identifier: BSD-3-Clause
// gaussmap simulate [SCENE] -o DIR: scans of a built-in world whose surfaces are known exactly.
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
    "Simulate scans of a built-in scene, with the exact truth",
    "gaussmap simulate street -o street --moving && gaussmap pcd2map street/scans -o street.gmap",
    R"(Scenes:
  corner  floor, two walls, a pole
  street  150 m with plane fronts, trees, poles, parked cars, a fence
  avenue  the same with fronts in relief and many trees
  hall    a hall, a corridor, furnished rooms
  plan    a floor plan with walls of 12 cm, for a planar laser

Files: DIR/scans/scan00.pcd ... (sensor frame, pose in VIEWPOINT; with --moving a field label: 1 = on a moving object)
and, in the map frame, DIR/truth.ply (all static surfaces; the rays are cast against these triangles), DIR/truth.pcd
(where the rays met them, without noise) and DIR/trajectory.tum. plan also writes DIR/walls.pcd, a map of segments.)"};

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
  if (options.field) throw UsageError("--field-of-view: only the laser of 'plan' has one");
  lidar.rings = options.rings.value_or(lidar.rings);
  lidar.columns = options.columns.value_or(lidar.columns);
}

void adapt(PlanarLaserOptions& laser, const SimulateCommand& options) {
  if (options.rings) throw UsageError("--rings: the laser of 'plan' has one ring");
  laser.beams = options.columns.value_or(laser.beams);
  laser.field_deg = options.field.value_or(laser.field_deg);
}

Simulation simulationOf(const SimulateCommand& options) {
  if (options.world.moving && options.scene != "street" && options.scene != "avenue")
    throw UsageError("--moving: only in the scenes 'street' and 'avenue'");
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
  command.choice("scene", options->scene, Command::wordsOf(kWorlds), "what to scan");
  command.output(options->output, "directory to write to");
  command
      .number("--scans", options->world.scans, 1, 100000,
              "number of scans, spread over the path of the scene; default: 5 to 240, by scene")
      .hideDefault();
  command.flag("--moving", options->world.moving, "three cars drive and two pedestrians walk through the street");
  command.number("--noise", options->noise, 0.0, 1e3, "standard deviation of the ranges [m]");
  command.number("--rings", options->rings, 1, 1000, "rings of the lidar; default: 32, street 64");
  command.number("--columns", options->columns, 1, 100000,
                 "directions per turn, or beams of the planar laser; default: 1800, plan 361");
  command.number("--field-of-view", options->field, 1.0, 360.0,
                 "field of view of the planar laser [degree]; default: 180");
  command.number("--max-range", options->max_range, 1e-3, 1e9,
                 "range of the sensor [m]; default: 60, street 80, plan 30");
  command.seed(options->seed, "seed of the noise");
  command.threads(options->threads);
  command.folders({"--output"});
  command.onRun([options] { run(*options); });
}

}  // namespace gaussmap::app
