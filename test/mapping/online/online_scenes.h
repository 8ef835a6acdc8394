// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/online/online_mapper.h"
#include "io/gmap/map_equality.h"
#include "mesh/shapes.h"
#include "simulation/lidar.h"
#include "simulation/simulation.h"

namespace gaussmap::test {

inline Scan asScan(const SimulatedScan& simulated) {
  return {simulated.points, simulated.pose, 0};
}

inline World worldOf(const std::vector<detail::Rectangle>& rectangles) {
  TriangleMesh mesh;
  for (const detail::Rectangle& rectangle : rectangles) append(mesh, detail::rectangleMesh(rectangle));
  return World(mesh);
}

/// A lidar without noise at the origin. boxScan() shows it a wall at x = 10.1 with boxes in front of it, at x = 5.1 and
/// with their right edges at the given y.
inline LidarOptions wallLidar() {
  LidarOptions lidar;
  lidar.rings = 40;
  lidar.lowest_deg = -10.0;
  lidar.highest_deg = 10.0;
  lidar.columns = 720;
  lidar.noise = 0.0;
  return lidar;
}
inline Scan boxScan(const std::vector<double>& boxes, const LidarOptions& lidar = wallLidar()) {
  std::vector<detail::Rectangle> rectangles = {{{10.1, -6.0, -2.0}, {0.0, 12.0, 0.0}, {0.0, 0.0, 4.0}}};
  for (const double y : boxes) rectangles.push_back({{5.1, y, -0.5}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}});
  return asScan(simulateScan(worldOf(rectangles), Pose(), lidar));
}
inline Scan wallScan(bool with_box) {
  return boxScan(with_box ? std::vector<double>{-0.5} : std::vector<double>{});
}

inline OnlineOptions wallOptions() {
  OnlineOptions options;
  options.map = {0.2, 5, 3, 0.0};
  options.look_back = 0;
  options.refine_every = 0;
  options.threads = 1;
  return options;
}

/// Returns a few scans of the hall, with fewer beams than usual.
inline std::vector<Scan> hallScans(int count) {
  SimulationOptions how;
  how.scans = count;
  Simulation hall = makeSimulation(WorldName::Hall, how);
  auto& lidar = std::get<LidarOptions>(hall.sensor);
  lidar.columns = 450;
  std::vector<Scan> scans;
  for (std::size_t i = 0; i < hall.trajectory.size(); ++i) scans.push_back(asScan(simulateScan(hall, i)));
  return scans;
}

inline std::vector<Vector<3>> inMap(const Scan& scan) {
  std::vector<Vector<3>> points;
  for (const Eigen::Vector3d& point : scan.points)
    if (isReturn(point)) points.push_back(scan.pose.rotation.toRotationMatrix() * point + scan.pose.translation);
  return points;
}

}  // namespace gaussmap::test
