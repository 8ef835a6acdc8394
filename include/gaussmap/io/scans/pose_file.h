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

/// A file of sensor poses in the map frame, one a line; blank lines and lines that start with # do not count:
///   time x y z qx qy qz qw                      TUM
///   r11 r12 r13 tx r21 r22 r23 ty r31 ... tz    KITTI, the rows of a 3 x 4 matrix
///   name x y z qx qy qz qw                      or the twelve numbers of KITTI after the file name of a scan
struct PoseFile {
  struct Entry {
    std::string name;      ///< first word as written: the time or the scan's file name; empty for KITTI
    std::size_t line = 0;  ///< in the file, from 1
    Pose pose;             ///< unit quaternion
  };
  std::filesystem::path path;
  std::vector<Entry> entries;  ///< in the order of the file
  bool by_name = false;        ///< the first words are file names, the order of the lines means nothing
};

/// Reads a pose file; which of the layouts it has shows in the words of a line and must not change. Throws FileError
/// with the line: a wrong number of words, numbers that are not finite, a quaternion whose norm is further than
/// kQuaternionTolerance from 1, a matrix as far from a rotation, the same name twice.
GAUSSMAP_API PoseFile readPoseFile(const std::filesystem::path& path);

/// The pose of each scan. By name: the entry named like the scan's file, with or without its extension; entries of
/// other scans do no harm. Times that are the names of all scans count as names. Otherwise in the order of the file,
/// which must have as many entries as there are scans. Throws FileError, naming the scan or the numbers.
GAUSSMAP_API std::vector<Pose> posesForScans(const PoseFile& file, const std::vector<std::filesystem::path>& scans);

}  // namespace gaussmap
