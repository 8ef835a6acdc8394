// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/editing/transform_map.h"

namespace gaussmap::app {

/// How maps are moved: the same options for every command that moves maps.
struct MotionInput {
  std::vector<std::string> transforms;  // "x y z qx qy qz qw"
  std::string file;
  std::string covariance;  // 6 or 36 numbers
};
void addMotionOptions(Command& command, MotionInput& input);

/// The motion of each map, in their order; empty if no motion is given. Throws UsageError, FileError.
std::vector<RigidMotion<3>> motionsOf(const MotionInput& input, const std::vector<std::filesystem::path>& maps);

}  // namespace gaussmap::app
