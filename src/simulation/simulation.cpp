// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulation.h"

#include <limits>
#include <stdexcept>
#include <string>

#include "core/check.h"
#include "gaussmap/core/gaussian.h"
#include "mesh/shapes.h"
#include "simulation/worlds.h"

namespace gaussmap {
using namespace detail;

namespace {

using namespace simulation;

int count(const SimulationOptions& options, int usual) {
  return options.scans > 0 ? options.scans : usual;
}

Simulation corner(const SimulationOptions& options) {
  constexpr double kStep = 2.0;  // [s]
  const std::vector<Pose> poses = cornerTrajectory();
  const int scans = count(options, static_cast<int>(poses.size()));
  return {World(cornerMesh()), interpolated(poses, scans, kStep), LidarOptions()};
}

/// Returns the street or the avenue, which have the same trajectory and the same traffic.
Simulation street(const TriangleMesh& mesh, const SimulationOptions& options) {
  const Pose placement = streetPlacement();
  std::vector<MovingObject> moving;
  if (options.moving)
    for (const MovingObject& object : streetTraffic())
      moving.push_back({transformed(object.mesh, placement), placement.rotation * object.velocity});
  LidarOptions lidar;
  lidar.rings = 64;
  lidar.max_range = 80.0;
  return {World(transformed(mesh, placement), std::move(moving)),
          drive(streetPath(), count(options, 20), {1.8, 4.7, 1.0}, placement), lidar};
}

Simulation hall(const SimulationOptions& options) {
  const Pose placement = hallPlacement();
  LidarOptions lidar;
  lidar.lowest_deg = -30.0;
  lidar.highest_deg = 30.0;
  return {World(transformed(hallMesh(), placement)), drive(hallPath(), count(options, 30), {1.2, 0.8, 0.5}, placement),
          lidar};
}

Simulation plan(const SimulationOptions& options) {
  const Pose placement = planPlacement();
  return {World(transformed(wallsMesh(planOutline()), placement)),
          drive(planPath(), count(options, 240), {0.0, 0.6, 0.0}, placement), PlanarLaserOptions()};
}

}  // namespace

Simulation makeSimulation(WorldName name, const SimulationOptions& options) {
  require(options.scans >= 0, "scans", options.scans, "must not be negative");
  if (options.moving && name != WorldName::Street && name != WorldName::Avenue)
    throw std::invalid_argument("moving objects: only the worlds street and avenue have them");
  switch (name) {
    case WorldName::Street:
      return street(streetMesh(), options);
    case WorldName::Avenue:
      return street(avenueMesh(), options);
    case WorldName::Hall:
      return hall(options);
    case WorldName::Plan:
      return plan(options);
    case WorldName::Corner:
      break;
  }
  return corner(options);
}

SimulatedScan simulateScan(const Simulation& simulation, std::size_t i, std::uint64_t seed) {
  const TimedPose& stop = simulation.trajectory.at(i);
  const std::uint64_t own_seed = Random::forPart(seed, i).bits();
  return std::visit(
      [&](const auto& sensor) { return simulateScan(simulation.world, stop.pose, sensor, own_seed, stop.time); },
      simulation.sensor);
}

std::vector<WallSegment> planWalls() {
  const Pose placement = planPlacement();
  const auto onMap = [&](const Eigen::Vector2d& point) -> Eigen::Vector2d {
    return (placement.rotation * Eigen::Vector3d(point.x(), point.y(), 0.0) + placement.translation).head<2>();
  };
  std::vector<WallSegment> walls;
  for (const Step& step : planOutline()) walls.push_back({onMap(step.from), onMap(step.to)});
  return walls;
}

}  // namespace gaussmap
