// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/core/pose.h"
#include "mesh/shapes.h"
#include "simulation/lidar.h"

namespace gaussmap::benchmark {

/// Returns points of a straight street, 200 m long, with ground, two building fronts and poles every 10 m. A 64-ring
/// lidar scans it every 2 m. The points are in the map frame, in packet order (all rings of a column, then the next
/// column). The drive starts again after 80 scans, with other noise. `threads`: 0 = all cores.
inline std::vector<Vector<3>> streetPoints(std::size_t count, std::uint64_t first_scan = 0, int threads = 0) {
  constexpr double kPole = 0.15;  // its radius [m]
  TriangleMesh mesh = detail::rectangleMesh({{-100, -15, 0}, {200, 0, 0}, {0, 30, 0}});
  for (const double y : {-15.0, 15.0}) append(mesh, detail::rectangleMesh({{-100, y, 0}, {200, 0, 0}, {0, 0, 12}}));
  for (double x = -95; x < 100; x += 10)
    for (const Eigen::Vector3d& foot : {Eigen::Vector3d(x, -6, 0), Eigen::Vector3d(x + 5, 6, 0)})
      append(mesh, detail::cylinderMesh({foot, {0, 0, 6}, kPole}, detail::facetsWithin(1e-4, kPole)));
  Pose turn;
  turn.rotation = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());  // walls not aligned with cells
  const World world(transformed(std::move(mesh), turn));
  LidarOptions lidar;
  lidar.rings = 64;
  lidar.max_range = 100.0;
  lidar.threads = threads;
  std::vector<Vector<3>> points;
  points.reserve(count + std::size_t{64} * 1800);
  for (std::uint64_t step = first_scan; points.size() < count; ++step) {
    Pose pose = turn;
    pose.translation = turn.rotation * Eigen::Vector3d(-80.0 + 2.0 * static_cast<double>(step % 80), 0.3, 1.8);
    for (const Eigen::Vector3d& point : simulateScan(world, pose, lidar, step).points) points.push_back(pose * point);
  }
  points.resize(count);
  return points;
}

}  // namespace gaussmap::benchmark
