// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/version.h"
#include "io/formats/scan_file.h"

namespace gaussmap::detail {

/// Options of openScanFile().
struct OpenOptions {
  FileOptions files;
  bool needs_poses = true;             ///< false: the poses come from elsewhere, those in the file are not searched
  std::optional<double> max_time_gap;  ///< of the poses in a recording [s], see PoseMatching::max_time_gap
  bool has_extrinsic = false;          ///< the poses are those of another frame, and it is known where the sensor is
  bool points_in_map = false;          ///< the points are in the map frame
};

/// Returns the options with which findScans() opens files.
GAUSSMAP_API OpenOptions openOptions(const FindScansOptions& options);

/// Opens a file, or the folder of a recording. The kind follows from the content; the name decides only between kinds
/// that the content cannot tell apart. Throws FileError, and std::invalid_argument for options that are not valid.
GAUSSMAP_API std::shared_ptr<const ScanFile> openScanFile(const std::filesystem::path& path,
                                                          const OpenOptions& options);

}  // namespace gaussmap::detail
