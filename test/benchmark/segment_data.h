// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/logs/carmen_log.h"
#include "gaussmap/segments/laser_scan.h"
#include "gaussmap/segments/segment_map.h"
#include "simulation/simulation.h"

namespace gaussmap::benchmark {

/// Returns the scans of the CARMEN log in a directory of a data set.
inline std::vector<LaserScan> readLogIn(const std::filesystem::path& folder) {
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (isCarmenLogName(entry.path())) return readCarmenLog(entry.path()).scans;
  throw FileError(folder, "no CARMEN log in this directory");
}

/// Returns every second scan, starting with scan `first`.
inline std::vector<LaserScan> half(const std::vector<LaserScan>& scans, std::size_t first) {
  std::vector<LaserScan> part;
  for (std::size_t i = first; i < scans.size(); i += 2) part.push_back(scans[i]);
  return part;
}

inline std::vector<Segment> truePlan() {
  std::vector<Segment> walls;
  for (const WallSegment& wall : planWalls()) {
    Segment segment;
    segment.start = wall.from;
    segment.end = wall.to;
    walls.push_back(segment);
  }
  return walls;
}

/// Returns scans of the simulated floor plan with noise of the ranges [m]. The position of each scan has its own normal
/// error of `position_noise` in x and y [m], and the covariance of the pose contains this error.
inline std::vector<LaserScan> scanPlan(double range_noise, double position_noise, std::uint64_t seed) {
  Simulation simulation = makeSimulation(WorldName::Plan);
  std::get<PlanarLaserOptions>(simulation.sensor).noise = range_noise;
  Random random = Random::forPart(seed, 1u << 20);
  std::vector<LaserScan> scans;
  for (std::size_t i = 0; i < simulation.trajectory.size(); ++i) {
    const SimulatedScan made = simulateScan(simulation, i, seed);
    LaserScan scan = planarScan({made.points, made.pose, 0});
    scan.pose.translation += position_noise * Vector<2>(random.normal(), random.normal());
    scan.pose.covariance.diagonal() << position_noise * position_noise, position_noise * position_noise, 0.0;
    scans.push_back(scan);
  }
  return scans;
}

}  // namespace gaussmap::benchmark
