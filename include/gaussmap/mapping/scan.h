// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/mapping/accumulate_scans.h"

namespace gaussmap {

/// One scan in memory, with what a range image needs to know of its sensor.
struct Scan {
  std::vector<Eigen::Vector3d> points;  ///< [m, SENSOR frame], NaN where the sensor saw nothing
  Pose pose;                            ///< sensor frame to map frame, unit quaternion
  int columns = 0;                      ///< points a row of an organised cloud; 0: in no order
};

/// All points of a file, in its order. Points that are given in the map frame are moved into the sensor's.
/// Throws FileError.
Scan loadScan(const ScanSource& source, ScanFrame frame = ScanFrame::Sensor);

}  // namespace gaussmap
