// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/core/pose.h"
#include "simulation/trajectory.h"

namespace gaussmap::simulation {

/// Returns the rotation by yaw, then pitch, then roll [degree].
Pose::Rotation turned(double yaw, double pitch, double roll);

/// Returns second * first: the motion by `first` and then by `second`.
Pose chained(const Pose& second, const Pose& first);

struct PathOptions {
  double height = 1.8;  ///< height of the sensor above the plan [m]
  double speed = 1.0;   ///< [m/s]
  double sway = 1.0;    ///< how much the sensor rolls and pitches on the way; 1: half a degree, like a vehicle
};

/// Returns `count` poses along a polyline with rounded corners, evenly spaced in time. The sensor looks ahead.
/// `placement` moves the poses from the plan to the map.
std::vector<TimedPose> drive(const std::vector<Eigen::Vector2d>& waypoints, int count, const PathOptions& options,
                             const Pose& placement);

/// Returns `count` poses interpolated evenly along the given poses. If `count` is their number, these are the given
/// poses. `step`: time from one given pose to the next [s].
std::vector<TimedPose> interpolated(const std::vector<Pose>& poses, int count, double step);

}  // namespace gaussmap::simulation
