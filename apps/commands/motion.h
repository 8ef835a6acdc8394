// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/command.h"
#include "gaussmap/editing/transform_map.h"

namespace gaussmap::app {

/// The options that all commands that move maps share.
struct MotionInput {
  std::vector<std::string> transforms;  // "x y z qx qy qz qw"
  std::string file;
  std::string covariance;  // 6 or 36 numbers
};
void addMotionOptions(Command& command, MotionInput& input);

/// Returns one motion per map, in the order of the maps; empty if no motion is given. Throws UsageError if an option is
/// wrong, and FileError if the file of poses is.
std::vector<RigidMotion<3>> motionsOf(const MotionInput& input, const std::vector<std::filesystem::path>& maps);

}  // namespace gaussmap::app
