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
  FileOptions files;
  std::vector<double> crop;  // x0 y0 x1 y1 or x0 y0 z0 x1 y1 z1 [m, map frame]; empty: no limit
  PoseMeaning meaning;
};
/// The endings of files of scans, for the completion of the shell.
std::vector<std::string> scanEndings();
/// Adds the positional argument of the paths.
void addScanPaths(Command& command, ScanInput& input);
/// Adds --poses and the options that say how it is read and matched, and addFileOptions().
void addPoseOptions(Command& command, ScanInput& input);
/// Adds the options of poses, --frame, --max-range, --min-range, --crop, --pose-convention and --no-pose-check.
void addScanOptions(Command& command, ScanInput& input);
/// Adds --max-range and --min-range.
void addRangeOptions(Command& command, ScanInput& input);

/// Throws UsageError if an option does not make sense, and FileError if an input does not exist.
FindScansOptions findOptions(const ScanInput& input);
/// Returns a convention that the poses cannot have, because of the way in which they are read.
std::optional<PoseConvention> impossibleConvention(const ScanInput& input);
/// Calls gaussmap::findScans(). Throws UsageError if --fields is not valid.
FoundScans findScans(const ScanInput& input, const FindScansOptions& options);
/// Calls findScans(). Prints its warnings on stderr, and how the poses were found if they are not those of PCD files.
/// For a command
/// that follows the rays of the sensor, `follows_rays` names it ("command clean"); the function then calls
/// requireSensorPositions() first. Throws like these functions, and std::runtime_error if the check of poses finds a
/// fault, see checkMeaning().
FileScans openScans(const ScanInput& input, int threads, const char* follows_rays = nullptr);
/// A coordinate reference system, as text, and the first file that has it.
struct FileSystem {
  std::string path, system;
};
/// Returns the different coordinate reference systems of the files.
std::vector<FileSystem> coordinateSystemsOf(const FileScans& scans);
/// Returns a warning if the files have different systems; else an empty text.
std::string warningOfSystems(const FileScans& scans);
/// Prints warnings about the coordinates that were read, see FileScans::coordinateWarnings(). Call it after reading.
void warnOfCoordinates(const FileScans& scans, double resolution);
/// Throws UsageError for ranges or a box that hold no point.
AccumulateOptions accumulateOptions(const ScanInput& input, double resolution, int threads);
/// Returns all points of the scans [m, map frame]. Throws std::runtime_error if no point is usable. Warns of
/// coordinates that are too coarse for cells of `resolution` [m].
std::vector<Vector<3>> readPoints(const ScanInput& input, int threads, double resolution = MapOptions().resolution);

/// The name of a scan without its folders: "scan.pcd", or "drive.bag: /points 1700000000.1" in a file of several scans.
std::string shortNameOf(const ScanInfo& scan);
/// The short names of all scans, with the last folder if names would be equal: "000000/cloud.pcd".
std::vector<std::string> shortNamesOf(const Scans& scans);
/// The name of the scans in messages: "scan.pcd", or "scan.pcd and 4 more".
std::string nameOf(const Scans& scans);

}  // namespace gaussmap::app
