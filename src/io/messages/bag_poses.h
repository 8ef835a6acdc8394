// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/pose.h"
#include "io/formats/scan_file.h"
#include "io/messages/bag_content.h"

namespace gaussmap::detail {

/// The poses of the scans of a recording.
struct AssignedBagPoses {
  std::vector<std::optional<Pose>> poses;  ///< one per scan
  std::string source;                      ///< "tf: lidar in map"; empty: no scan has a pose
  std::string map_frame;                   ///< frame of the poses
  MissingPoses missing;                    ///< of scans without a pose
  bool in_fixed_frame = false;             ///< the points are in the fixed frame already
  std::vector<std::string> warnings;
};

/// Gives each scan its pose, see openBagScans(). Throws FileError.
AssignedBagPoses assignBagPoses(const std::filesystem::path& path, const BagContent& content,
                                const BagOptions& options);

}  // namespace gaussmap::detail
