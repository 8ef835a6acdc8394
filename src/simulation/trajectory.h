// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/pose.h"

namespace gaussmap {

/// The pose of a sensor at a time.
struct TimedPose {
  double time = 0.0;  ///< [s]
  Pose pose;          ///< sensor frame to map frame
};

/// Writes a trajectory as TUM lines: time x y z qx qy qz qw. Reading a number back gives the same double. The update of
/// the file is atomic (AtomicFile). Throws std::invalid_argument, with the number of the pose, if a pose has a fault
/// (see poseFault()) or its time is not finite; FileError if the file cannot be written.
void writeTum(const std::filesystem::path& path, const std::vector<TimedPose>& trajectory);

}  // namespace gaussmap
