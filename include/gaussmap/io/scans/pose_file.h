// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/pose.h"
#include "gaussmap/version.h"

namespace gaussmap {

/// Kinds of pose files. The separators are blanks, tabs, commas or semicolons.
enum class PoseFormat {
  Automatic,      ///< recognised from the content
  Tum,            ///< `key x y z qx qy qz qw`; the key is a time, an index or the name of a scan
  Kitti,          ///< the 12 numbers of a 3 x 4 matrix, row by row; a key in front is allowed
  Matrix4,        ///< the 16 numbers of a 4 x 4 matrix, in one line or in four; a key in front is allowed
  EuRoc,          ///< `time x y z qw qx qy qz`, time in ns; further columns are ignored
  XyzRpyDegrees,  ///< `key x y z roll pitch yaw`, degrees; the key may be missing
  XyzRpyRadians,  ///< the same in radians
  G2o,            ///< the vertices VERTEX_SE3:QUAT and VERTEX_SE2 of a pose graph
  Table           ///< the names of the columns decide, in a header line or given
};

/// A file of poses.
struct PoseFile {
  /// One pose of the file.
  struct Entry {
    std::string name;                              ///< key in front as written, for example the name of a scan
    std::optional<std::uint64_t> index;            ///< number of the scan
    std::optional<std::chrono::nanoseconds> time;  ///< exact, since the zero of the file's clock
    std::size_t line = 0;                          ///< line number, from 1
    std::optional<Pose> pose;                      ///< sensor to map frame, unit quaternion; std::nullopt for NaN
  };
  std::filesystem::path path;                 ///< the file
  PoseFormat format = PoseFormat::Automatic;  ///< as recognised, never Automatic
  std::string layout;                         ///< for messages: "time x y z qx qy qz qw"
  std::vector<Entry> entries;                 ///< in the order of the file
  bool by_name = false;                       ///< true: the keys are names of scans
  /// true: the indices may be other ids, not numbers of scans: ids behind the pose (RTAB-Map), ids of the vertices of
  /// a pose graph, or whole numbers in a column named time.
  bool indices_may_be_ids = false;
  std::vector<std::string> warnings;  ///< one or two sentences each; matchPoses() repeats them
};

/// Reads a pose file.
///
/// A header line, also behind `#`, gives the columns if it names all parts of a pose. Without one, the kind follows
/// from the numbers. Roll, pitch and yaw mean R = Rz(yaw) Ry(pitch) Rx(roll). `columns` are the names of the columns of
/// a PoseFormat::Table, for example "time x y z qw qx qy qz"; empty: the header line.
///
/// Throws FileError, with the line, in these cases:
/// - The kind is not clear. The message says how to state it.
/// - The lines have different layouts, or a number is infinite. A line with NaN in place of all numbers has no pose.
/// - The norm of a quaternion differs from 1 by more than kQuaternionTolerance, or a matrix differs from a rotation by
///   as much.
/// - A name occurs twice.
GAUSSMAP_API PoseFile readPoseFile(const std::filesystem::path& path, PoseFormat format = PoseFormat::Automatic,
                                   const std::string& columns = "");

/// How scans and poses belong together.
enum class PoseMatch {
  Automatic,  ///< by name, else by time or index if the file and the scans have them, else by order
  Name,       ///< the file names the scan
  Index,      ///< the number in the scan's name is the index, or the number of the line counted from 0
  Time,       ///< the nearest time
  Order       ///< one line per scan, in the order of the file
};

/// Options of matchPoses().
struct PoseMatching {
  PoseMatch match = PoseMatch::Automatic;
  /// [s]; std::nullopt: half of the median interval between scans (for one scan: between poses), at most 10 s; with
  /// `interpolate` at least 1.2 times the median interval between poses
  std::optional<double> max_time_gap;
  bool interpolate = false;  ///< between the poses before and after: linear and slerp; false: the nearest pose
};

/// A scan to which a pose belongs.
struct ScanKey {
  std::string name;                              ///< file name
  std::optional<std::chrono::nanoseconds> time;  ///< std::nullopt: the time in the name, if there is one
};

/// The poses of scans.
struct MatchedPoses {
  /// A scan without a pose.
  struct Missing {
    std::size_t scan = 0;  ///< index of the scan
    std::string reason;    ///< "0.48 s from the nearest pose"
  };
  std::vector<std::optional<Pose>> poses;  ///< one per scan
  std::vector<Missing> missing;            ///< the scans without a pose, in order
  PoseMatch match = PoseMatch::Order;      ///< how they were matched, never Automatic
  std::string how;                         ///< for messages: "matched by time, at most 0.05 ms apart"
  std::vector<std::string> warnings;       ///< one or two sentences each
};

/// Gives each scan its pose.
///
/// Times in names are decimal numbers or integers in s, ms, us or ns, or pairs of seconds and nanoseconds. The unit
/// follows from the magnitude, and is the same for all scans. Times are compared exactly. Dates are read as UTC. The
/// order of the lines counts only if the file and the scans have no common keys; with PoseMatch::Automatic, lines with
/// times or indices are sorted first. Throws FileError if the numbers of scans and poses then differ,
/// or if two poses fit a scan equally well.
GAUSSMAP_API MatchedPoses matchPoses(const PoseFile& file, const std::vector<ScanKey>& scans,
                                     const PoseMatching& options = {});

/// Returns the pose of each scan or map, by name or by order, never by time.
///
/// If the file has names, a scan gets the entry named like its file, with or without extension. Entries of other scans
/// are ignored. Times that are the names of all scans count as names. Otherwise the poses are in the order of the file,
/// which must have one entry per scan. Throws FileError if a scan has no pose or the numbers differ; the message gives
/// the scan or the numbers.
GAUSSMAP_API std::vector<Pose> posesForScans(const PoseFile& file, const std::vector<std::filesystem::path>& scans);

}  // namespace gaussmap
