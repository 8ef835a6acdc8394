// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/core/scans.h"

namespace gaussmap::detail {

/// What a file says about one of its scans, before the points are read.
struct FileScanInfo {
  std::string name;                                             ///< in a file with several scans: "scan 3"; else empty
  std::size_t points = 0;                                       ///< including points without a return
  std::optional<Pose> pose = std::nullopt;                      ///< sensor frame to map frame; std::nullopt: unknown
  std::optional<std::chrono::nanoseconds> time = std::nullopt;  ///< exact, since the zero of the file's clock
  /// Pose of the sensor in RecordingOptions::pose_frame, for poses from a pose file; std::nullopt: such poses are those
  /// of the sensor.
  std::optional<Pose> sensor_in_pose_frame = std::nullopt;
  double position_step = 0.0;     ///< step in which the position of the pose is written as text [m]; 0: unknown
  std::uint64_t fingerprint = 0;  ///< differs between files with different points; 0: unknown
};

/// Why scans of a file have no pose.
struct MissingPoses {
  std::string reason;  ///< for messages: "2 of 10 scans have no pose, first ..."
  std::string advice;  ///< what to do: "use --skip-without-pose to leave such scans out"
};

/// An open file with one or more scans. The implementations read one kind of file each. All functions are thread-safe.
///
/// Opening reads the header and checks it against the size of the file, but reads no points. No file can make a reader
/// crash, hang, or use more memory than a small multiple of the file's size. Readers throw FileError with the place in
/// the file, what was found, what was expected, and what to do.
class ScanFile {
 public:
  virtual ~ScanFile() = default;

  /// Returns the kind of the file, for messages and tables: "PLY binary_little_endian", "LAS 1.2, point format 3".
  virtual std::string kind() const = 0;
  /// Returns the number of scans in the file.
  virtual std::size_t size() const = 0;
  /// Returns what the file says about a scan. `scan` must be less than size().
  virtual FileScanInfo info(std::size_t scan) const = 0;
  /// Returns a reader of the points and the values of a scan. The reader can outlive this object. `scan` must be less
  /// than size().
  ///
  /// The points [m] are in the sensor frame, or in the map frame if inMapFrame() is true. The names of the values are
  /// those of PCL if there is one: "intensity", "ring", "rgb", "label", "time" [s].
  virtual std::unique_ptr<ScanReader> open(std::size_t scan) const = 0;

  /// Returns where the poses of the scans come from, for messages; empty if no scan has a pose.
  virtual std::string poseSource() const { return ""; }
  /// Returns why scans have no pose; empty if all have one, or if files of this kind have no poses.
  virtual MissingPoses missingPoses() const { return {}; }
  /// Returns the name of the frame of the poses, for example "odom"; empty if the file has no such names.
  virtual std::string mapFrame() const { return ""; }
  /// Returns true if the points are in the map frame, and the file does not say where the sensor was, as in LAS.
  virtual bool inMapFrame() const { return false; }
  /// Returns the memory that a reader of the scan takes after the points were read [bytes], about; 0 if it takes none
  /// because it reads the points from the file each time.
  virtual std::size_t memoryOf(std::size_t scan) const { return 3 * sizeof(double) * info(scan).points; }
  /// Gives the memory of the pages of the file that were read back to the operating system. The file can still be read.
  virtual void releasePages() const {}
  /// Returns the coordinate reference system as text (WKT), or an empty string.
  virtual std::string coordinateSystem() const { return ""; }
  /// Returns warnings about the file, one or two sentences each, without the path.
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace gaussmap::detail
