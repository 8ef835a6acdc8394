// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

/// Checks what the poses of scans mean, see detail::checkPoses().
///
/// Returns a message with the option to use if neighbouring scans fit each other clearly better with another
/// convention, or with points in another frame; otherwise "". `convention`: of the poses, as the program was
/// told. `threads`: 0 = all cores.
std::string faultOfPoses(FoundScans& found, PoseConvention convention, int threads);

}  // namespace gaussmap::app
