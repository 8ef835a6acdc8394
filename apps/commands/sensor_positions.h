// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gaussmap/io/scans/file_scans.h"

namespace gaussmap::app {

/// Checks scans for a command that follows the rays of the sensor. Throws std::runtime_error if a file does not say
/// where the sensor was, or if all scans have the same sensor position, but their points show that the sensor moved.
/// `follower` is used in the message: "command clean".
void requireSensorPositions(const FileScans& scans, const char* follower);

}  // namespace gaussmap::app
