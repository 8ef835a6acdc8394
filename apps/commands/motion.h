// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/core/pose.h"

namespace gaussmap::app {

/// The options that all commands that move maps share.
struct MotionInput {
  std::vector<std::string> transforms;  // "x y z qx qy qz qw"
  std::string file;
  std::string covariance;  // 6 or 36 numbers
};
void addMotionOptions(Command& command, MotionInput& input);

struct Motions {
  std::vector<Pose> poses;                   // one per map, in the order of the maps; empty if no motion is given
  std::optional<PoseCovariance> covariance;  // of every pose
};

/// Returns one motion per map. Throws UsageError if an option is wrong, and FileError if the file of poses is.
Motions motionsOf(const MotionInput& input, const std::vector<std::filesystem::path>& maps);

}  // namespace gaussmap::app
