// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/pose.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// A file of sensor poses in the map frame, one per line.
///
/// Blank lines and lines that start with `#` are ignored. The layouts are:
///
///     time x y z qx qy qz qw                      TUM
///     r11 r12 r13 tx r21 r22 r23 ty r31 ... tz    KITTI: the rows of a 3 x 4 matrix
///     name x y z qx qy qz qw                      the file name of a scan and a pose
///     name r11 r12 r13 tx r21 ... tz              the file name of a scan and a matrix
struct PoseFile {
  /// One pose of the file.
  struct Entry {
    std::string name;      ///< first word as written: the time, or the file name of the scan; empty for KITTI
    std::size_t line = 0;  ///< line number, from 1
    Pose pose;             ///< sensor frame to map frame, unit quaternion
  };
  std::filesystem::path path;  ///< the file
  std::vector<Entry> entries;  ///< in the order of the file
  bool by_name = false;        ///< true: the first words are file names, and the order of the lines does not matter
};

/// Reads a pose file. The layout follows from the words of a line and must be the same in all lines.
///
/// Throws FileError, with the line, in these cases:
/// - The number of words is wrong, or a number is not finite.
/// - The norm of a quaternion differs from 1 by more than kQuaternionTolerance, or a matrix differs from a rotation by
///   as much.
/// - A name occurs twice.
GAUSSMAP_API PoseFile readPoseFile(const std::filesystem::path& path);

/// Returns the pose of each scan.
///
/// If the file has names, a scan gets the entry named like its file, with or without extension. Entries of other scans
/// are ignored. Times that are the names of all scans count as names. Otherwise the poses are in the order of the file,
/// which must have one entry per scan. Throws FileError if a scan has no pose or the numbers differ; the message gives
/// the scan or the numbers.
GAUSSMAP_API std::vector<Pose> posesForScans(const PoseFile& file, const std::vector<std::filesystem::path>& scans);

}  // namespace gaussmap
