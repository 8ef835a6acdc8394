// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "commands/pose_meaning.h"
#include "common/command.h"
#include "gaussmap/io/scans/file_scans.h"
#include "gaussmap/mapping/build.h"

namespace gaussmap::app {

/// The scans and their frame: the options that all commands that read scans share.
struct ScanInput {
  std::vector<std::string> paths;
  std::string poses;
  std::string pose_format = "auto";  // a kind of PoseFormat, or the names of the columns
  std::string match_poses = "auto";
  std::optional<double> max_time_gap;  // [s]
  bool interpolate = false;
  bool skip_without_pose = false;
  std::string extrinsic;  // file, seven numbers or "none"
  std::string frame = "sensor";
  double max_range = 0.0;  // 0: no limit
  double min_range = 0.0;
  std::vector<double> crop;  // x0 y0 x1 y1 or x0 y0 z0 x1 y1 z1 [m, map frame]; empty: no limit
  PoseMeaning meaning;
};
/// Adds the positional argument of the paths.
void addScanPaths(Command& command, ScanInput& input);
/// Adds --poses and the options that say how it is read and matched.
void addPoseOptions(Command& command, ScanInput& input);
/// Adds the options of poses, --frame, --max-range, --min-range, --crop, --pose-convention and --no-pose-check.
void addScanOptions(Command& command, ScanInput& input);
/// Adds --max-range and --min-range.
void addRangeOptions(Command& command, ScanInput& input);

/// Throws UsageError if an option does not make sense.
FindScansOptions findOptions(const ScanInput& input);
/// Returns a convention that the poses cannot have, because of the way in which they are read.
std::optional<PoseConvention> impossibleConvention(const ScanInput& input);
/// Calls findScans(). Prints its warnings on stderr, and, with a pose file, how the poses were found. For a command
/// that follows the rays of the sensor, `follows_rays` names it ("command clean"); the function then calls
/// requireSensorPositions() first. Throws like these functions, and std::runtime_error if the check of poses finds a
/// fault, see checkMeaning().
FileScans openScans(const ScanInput& input, int threads, const char* follows_rays = nullptr);
/// Prints warnings about the coordinates that were read, see FileScans::coordinateWarnings(). Call it after reading.
void warnOfCoordinates(const FileScans& scans, double resolution);
/// Throws UsageError for ranges or a box that hold no point.
AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads);
/// Returns all points of the scans [m, map frame]. Throws std::runtime_error if no point is usable. Warns of
/// coordinates that are too coarse for cells of `resolution` [m].
std::vector<Vector<3>> readPoints(const ScanInput& input, int threads, double resolution = MapOptions().resolution);

/// The name of the scans in messages: "scan.pcd", or "scan.pcd and 4 more".
std::string nameOf(const Scans& scans);

}  // namespace gaussmap::app
