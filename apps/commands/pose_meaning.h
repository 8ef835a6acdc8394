// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "common/command.h"
#include "gaussmap/io/scans/file_scans.h"

namespace gaussmap::app {

/// What the poses of the scans mean: the options of all commands that read scans.
struct PoseMeaning {
  PoseConvention convention = PoseConvention::SensorToMap;
  bool check = true;
};
/// Adds --pose-convention and --no-pose-check.
void addPoseMeaning(Command& command, PoseMeaning& meaning);

/// What the check of poses found. Both texts are empty if the scans fit each other.
struct PoseFinding {
  std::string fault;    ///< the poses mean something else; the text names the option to use
  std::string warning;  ///< the scans do not fit each other, and no other meaning of the poses explains it
};

/// Checks what the poses of scans mean, see detail::checkPoses(). `never`: a convention that the poses cannot have, or
/// std::nullopt. `threads`: 0 = all cores.
PoseFinding checkMeaning(FoundScans& found, const PoseMeaning& meaning, std::optional<PoseConvention> never,
                         int threads);

}  // namespace gaussmap::app
