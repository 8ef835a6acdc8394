// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/pose.h"
#include "gaussmap/io/pcd/pcd_reader.h"

namespace gaussmap::detail {

/// Input of the pose checks for one scan; small enough to keep for all scans.
struct ScanPose {
  std::filesystem::path path;
  Pose pose;                      ///< as given, the quaternion not normalised yet
  std::uint64_t fingerprint = 0;  ///< PcdReader::fingerprint()
};

/// The pose in the scan's own header; for a pose from elsewhere replace `pose`. Reads a few kilobytes of the file.
ScanPose scanPose(const PcdReader& reader);

struct PoseDiagnosis {
  std::vector<std::string> warnings;  ///< one sentence or two each, with file names and the way out
};

/// Checks the poses of all scans before a map is built of them. Throws FileError naming the scan if a pose cannot be
/// used, see poseFault(). Warns if scans that differ stand at one and the same pose, all of them or all those without
/// a pose of their own (the identity), and of translations beyond 1e8 m.
PoseDiagnosis diagnosePoses(const std::vector<ScanPose>& scans);

}  // namespace gaussmap::detail
