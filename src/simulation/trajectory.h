// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/pose.h"

namespace gaussmap {

/// Where a sensor was when.
struct TimedPose {
  double time = 0.0;  ///< [s]
  Pose pose;          ///< sensor frame to map frame
};

/// Writes a trajectory as TUM lines, time x y z qx qy qz qw, every number with the digits that give back the same
/// double; whole or not at all (AtomicFile). Throws std::invalid_argument, naming the pose, if one has a fault (see
/// poseFault()) or its time is not finite; FileError if the file cannot be written.
void writeTum(const std::filesystem::path& path, const std::vector<TimedPose>& trajectory);

}  // namespace gaussmap
