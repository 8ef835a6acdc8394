// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gaussmap/io/scans/file_scans.h"
#include "io/scans/pose_checks.h"

namespace gaussmap::detail {

/// What assignPoses() found out.
struct AssignedPoses {
  std::string description;                   ///< where the poses come from, one sentence
  std::vector<std::string> warnings;         ///< one or two sentences each
  std::vector<bool> left_out;                ///< per scan: it has no pose
  std::vector<std::string> without_pose;     ///< the scans left out, with the reason
  std::vector<std::optional<double>> times;  ///< per scan: the time in its name [s]
  std::vector<Pose> as_read;                 ///< per scan: before its convention and the extrinsic were applied
  Pose extrinsic;                            ///< that was applied
};

/// Replaces the poses of the scans by those of the pose file, and applies their convention and the extrinsic. Throws
/// FileError if a scan has no pose and such scans are not to be left out.
GAUSSMAP_API AssignedPoses assignPoses(std::vector<ScanPose>& scans, const FindScansOptions& options);

}  // namespace gaussmap::detail
