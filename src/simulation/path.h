// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/core/pose.h"
#include "simulation/trajectory.h"

namespace gaussmap::simulation {

/// Yaw, then pitch, then roll [degree].
Pose::Rotation turned(double yaw, double pitch, double roll);

/// Where a body is that is placed by `first` within what is placed by `second`.
Pose chained(const Pose& second, const Pose& first);

struct PathOptions {
  double height = 1.8;  ///< of the sensor above the plan [m]
  double speed = 1.0;   ///< [m/s]
  double sway = 1.0;    ///< how much the sensor rolls and pitches on the way; 1: half a degree, as vehicles do
};

/// `count` poses evenly spaced in time along a polyline with rounded corners, looking ahead; moved by `placement`.
std::vector<TimedPose> drive(const std::vector<Eigen::Vector2d>& waypoints, int count, const PathOptions& options,
                             const Pose& placement);

/// `count` poses evenly spaced along a few given ones, those included if their number is `count`, `step` [s] from one
/// given pose to the next.
std::vector<TimedPose> interpolated(const std::vector<Pose>& poses, int count, double step);

}  // namespace gaussmap::simulation
