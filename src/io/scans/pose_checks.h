// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/pose.h"
#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// What a file says about the poses of its scans.
struct PosesInFile {
  std::string source;    ///< ScanFile::poseSource()
  MissingPoses missing;  ///< ScanFile::missingPoses()
};

/// Input of the pose checks for one scan; small enough to keep for all scans.
struct ScanPose {
  std::filesystem::path path;
  Pose pose;                      ///< as given, with a quaternion that is not normalised
  std::uint64_t fingerprint = 0;  ///< differs between different clouds
  double position_step = 0.0;     ///< PcdHeader::viewpoint_step; 0 if the pose comes from elsewhere
  std::optional<Pose> sensor_in_pose_frame = std::nullopt;  ///< FileScanInfo::sensor_in_pose_frame
  bool has_pose = true;       ///< false: the file gives no pose, and `pose` is the identity
  bool in_map_frame = false;  ///< true: no pose is needed
  std::string name = "";      ///< of the scan in a file with several scans
  std::optional<std::chrono::nanoseconds> time = std::nullopt;  ///< from the file
  std::shared_ptr<const PosesInFile> file_poses = nullptr;      ///< nullptr: as if both texts were empty

  /// Returns the name for messages.
  std::string label() const { return path.string() + (name.empty() ? "" : ": " + name); }
};

/// For points that are in the map frame: replaces rotations that are not valid by the identity, and positions that are
/// not finite by the origin, because such points need no pose. Adds one warning if that happens.
void dropUnneededRotations(std::vector<ScanPose>& scans, std::vector<std::string>& warnings);

struct PoseDiagnosis {
  std::vector<std::string> warnings;  ///< one or two sentences each, with file names and what to do
  std::string same_pose;              ///< a warning if all scans have the same pose but differ; else empty
};

/// Checks the poses of all scans before a map is built from them. Throws FileError with the name of the scan if a pose
/// cannot be used, see poseFault().
///
/// Warns if different clouds have the same pose: either all scans, or those scans whose pose is the identity because
/// they have no pose of their own. Warns of translations beyond 1e8 m, and of positions that were written with too few
/// digits.
PoseDiagnosis diagnosePoses(const std::vector<ScanPose>& scans);

}  // namespace gaussmap::detail
