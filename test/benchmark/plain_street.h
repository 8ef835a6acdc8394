// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "gaussmap/simulation/mesh_shapes.h"
#include "gaussmap/simulation/simulation.h"

namespace gaussmap::benchmark_input {

/// A street of 150 m with one of each kind of thing and little detail: ground, sidewalks behind a kerb, plane building
/// fronts with corners, a pole every 20 m, trees with closed crowns, parked cars of two boxes, a fence. The sensor is
/// that of WorldName::Street.
inline Simulation plainStreet(const SimulationOptions& options = {}) {
  TriangleMesh mesh = rectangleMesh({{-20, -5, 0}, {150, 0, 0}, {0, 10, 0}});
  constexpr double kKerb = 0.12;
  for (const double side : {-1.0, 1.0}) {
    append(mesh, rectangleMesh({{-20, 5 * side, 0}, {150, 0, 0}, {0, 0, kKerb}}));
    append(mesh, rectangleMesh({{-20, 5 * side, kKerb}, {150, 0, 0}, {0, 6 * side, 0}}));
    for (int i = 0; i < 10; ++i) {  // 15 m of front each, a gap after every fourth
      const double x = -20 + 15.0 * i, y = side * (8.5 + 0.6 * ((3 * i) % 4)), end = i % 4 == 3 ? 12.0 : 15.0;
      append(mesh, boxMesh({x, std::min(y, 20 * side), 0}, {x + end, std::max(y, 20 * side), 10.0 + i % 3}));
    }
    for (double x = -12 + 5 * side; x < 130; x += 20)
      append(mesh, cylinderMesh({{x, 5.5 * side, kKerb}, {0, 0, 6}, 0.1}, 16));
    for (double x = -4 + 7 * side; x < 130; x += 30) {
      append(mesh, cylinderMesh({{x, 6.2 * side, kKerb}, {0, 0, 3.4}, 0.16}, 16));
      append(mesh, ellipsoidMesh({x, 6.2 * side, 4.3}, {1.5, 1.5, 1.3}, 32));
    }
    for (double x = 3 + 6 * side; x < 130; x += 25) {
      append(mesh, boxMesh({x, 4 * side - 0.88, 0.25}, {x + 4.3, 4 * side + 0.88, 0.95}));
      append(mesh, boxMesh({x + 1.0, 4 * side - 0.75, 0.95}, {x + 3.4, 4 * side + 0.75, 1.45}));
    }
  }
  append(mesh, boxMesh({60, 7.0, kKerb}, {90, 7.05, 1.2}));

  Simulation street = makeSimulation(WorldName::Street, options);
  Pose placement;
  placement.rotation = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(-0.01, Eigen::Vector3d::UnitY());  // not aligned with cells
  placement.translation = {-41.3, -27.8, 0.063};
  street.world = World(transformed(mesh, placement));
  const std::size_t scans = street.trajectory.size();
  for (std::size_t i = 0; i < scans; ++i) {
    const double x = scans == 1 ? 55.0 : 8.0 + 94.0 * static_cast<double>(i) / static_cast<double>(scans - 1);
    street.trajectory[i].pose = {placement.rotation * Eigen::Vector3d(x, -1.5, 1.8) + placement.translation,
                                 placement.rotation};
  }
  return street;
}

}  // namespace gaussmap::benchmark_input
