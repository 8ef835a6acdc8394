// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "simulation/lidar.h"
#include "simulation/trajectory.h"
#include "simulation/world.h"

namespace gaussmap {

/// The built-in worlds. All are rotated: no wall is aligned with the cells of a map.
enum class WorldName {
  Corner,  ///< a floor of 20 m x 12 m, two walls of 4 m height that meet at a right angle, and a pole
  Street,  ///< 150 m of a street between plane building fronts, with poles, some trees, parked cars and a fence; it
           ///< rises a little
  Avenue,  ///< the same path between fronts with windows and oriels in relief, with 27 trees, vans and cars, lamps,
           ///< benches, a side road and a park: much more detail in the same length
  Hall,    ///< a high hall with columns, a corridor and four rooms, furnished
  Plan     ///< a floor plan: rooms along a corridor between walls of 12 cm, for a planar laser; z = 0 is its plane
};

struct SimulationOptions {
  int scans = 0;  ///< number of scans, spread evenly over the same trajectory and time; 0: the default of the world
  bool moving = false;  ///< Street and Avenue: three cars drive, two pedestrians walk
};

/// A world, a sensor, and the trajectory of the sensor in the world.
struct Simulation {
  World world;
  std::vector<TimedPose> trajectory;                      ///< one pose per scan, from time 0 on
  std::variant<LidarOptions, PlanarLaserOptions> sensor;  ///< the default of the world, may be changed
};

/// Returns a built-in simulation. Throws std::invalid_argument if scans < 0, or if moving objects are requested for a
/// world that has none.
Simulation makeSimulation(WorldName name, const SimulationOptions& options = {});

/// Returns scan number i. The scans of one seed have independent noise. Throws std::out_of_range if there is no such
/// scan; otherwise like simulateScan() of a world.
SimulatedScan simulateScan(const Simulation& simulation, std::size_t i, std::uint64_t seed = 1);

/// A straight piece of wall in the plane of WorldName::Plan, free space on its left.
struct WallSegment {
  Eigen::Vector2d from, to;  ///< [m], map frame
};
/// Returns all walls of the plan: the lines where its mesh intersects the plane z = 0.
std::vector<WallSegment> planWalls();

}  // namespace gaussmap
