// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/command.h"
#include "gaussmap/io/scans/pcd_scans.h"
#include "registration/pose_convention.h"

namespace gaussmap::app {

/// What the poses of the scans mean: the options of all commands that read scans.
struct PoseMeaning {
  detail::PoseConvention convention = detail::PoseConvention::SensorToMap;
  bool check = true;
};
/// Adds --pose-convention and --no-pose-check.
void addPoseMeaning(Command& command, PoseMeaning& meaning);

/// Returns the scans with their poses converted, so that they move points from the sensor frame into the map frame.
///
/// Throws std::runtime_error if the check of poses finds another convention, or points in another frame, with which
/// neighbouring scans fit each other clearly better. The message gives the option to use.
PcdScans withMeaning(PcdScans scans, const PoseMeaning& meaning);

}  // namespace gaussmap::app
