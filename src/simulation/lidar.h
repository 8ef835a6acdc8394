// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gaussmap/core/pose.h"
#include "simulation/world.h"

namespace gaussmap {

/// A spinning lidar: `rings` lasers one above the other, which turn about the z axis of the sensor.
struct LidarOptions {
  int rings = 32;             ///< >= 1, evenly spaced in elevation
  double lowest_deg = -25.0;  ///< elevation of ring 0 [degree], > -90
  double highest_deg = 15.0;  ///< elevation of the last ring [degree], < 90
  int columns = 1800;         ///< directions in one turn, >= 1; column 0 looks along x, then counter-clockwise
  double noise = 0.01;        ///< standard deviation of a range [m], >= 0
  double max_range = 60.0;    ///< [m], > 0; farther surfaces give no return
  int threads = 0;            ///< 0 = all cores
};

/// A planar laser: one fan of beams in the plane z = 0 of the sensor, the middle of the fan along x.
struct PlanarLaserOptions {
  int beams = 361;           ///< >= 1, counter-clockwise from the right end of the fan
  double field_deg = 180.0;  ///< angle between first and last beam [degree]; 360: a full turn without a repeated beam
  double noise = 0.01;       ///< standard deviation of a range [m], >= 0
  double max_range = 30.0;   ///< [m], > 0; farther surfaces give no return
  int threads = 0;           ///< 0 = all cores
};

/// One turn of the sensor. The points are in the order in which the sensor sends them: column by column, and within a
/// column from the lowest ring to the highest; or beam by beam. Rays without a return are left out.
struct SimulatedScan {
  std::vector<Eigen::Vector3d> points;  ///< n measured points [m], SENSOR frame
  std::vector<Eigen::Vector3d> truth;   ///< n points where the rays hit the surface [m], map frame, without noise
  std::vector<SurfaceLabel> labels;     ///< n, which kind of surface each ray hit
  Pose pose;                            ///< pose of the sensor: truth = pose * point, apart from the noise
};

/// Simulates a scan: casts the rays against the surfaces as they are at `time` [s]. Each range gets normal noise along
/// its ray; the same seed gives the same noise. A surface at less than 1e-4 rad to the ray gives no return, therefore
/// without noise every point lies on a surface within 1e-9 m. Sensor and objects do not move during the turn. Throws
/// std::invalid_argument if an option or the pose is not usable (see poseFault()).
SimulatedScan simulateScan(const World& world, const Pose& sensor_pose, const LidarOptions& options = {},
                           std::uint64_t seed = 1, double time = 0.0);
SimulatedScan simulateScan(const World& world, const Pose& sensor_pose, const PlanarLaserOptions& options,
                           std::uint64_t seed = 1, double time = 0.0);

}  // namespace gaussmap
