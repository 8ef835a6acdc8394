// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/core/pose.h"

namespace gaussmap::app {

/// How maps are moved: the same options for every command that moves maps.
struct MotionInput {
  std::vector<std::string> transforms;  // "x y z qx qy qz qw"
  std::string file;
  std::string covariance;  // 6 or 36 numbers
};
void addMotionOptions(Command& command, MotionInput& input);

struct Motions {
  std::vector<Pose> poses;                   // of each map, in their order; empty if no motion is given
  std::optional<PoseCovariance> covariance;  // of every pose
};

/// Throws UsageError, FileError.
Motions motionsOf(const MotionInput& input, const std::vector<std::filesystem::path>& maps);

}  // namespace gaussmap::app
