// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/open_scan_file.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "gaussmap/io/logs/carmen_log.h"
#include "io/bags/recording.h"
#include "io/e57/e57_file.h"
#include "io/files/gunzip.h"
#include "io/files/mapped_file.h"
#include "io/files/text.h"
#include "io/formats/kind_of_start.h"
#include "io/formats/message_file.h"
#include "io/las/las_file.h"
#include "io/laz/laz_file.h"
#include "io/logs/carmen_scans.h"
#include "io/messages/bag_scans.h"
#include "io/pcd/pcd_header.h"
#include "io/pcd/pcd_scan_file.h"
#include "io/ply/ply_cloud.h"
#include "io/scans/scan_names.h"
#include "io/text/cloud_text.h"
#include "io/text/float_records.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kStart = 4096;  // bytes that tell the kind of a file

BagPoses bagPosesOf(const OpenOptions& options) {
  if (!options.needs_poses) return BagPoses::None;
  const std::string& poses = options.files.recording.poses;
  if (poses.empty()) return BagPoses::Automatic;
  return poses == "tf" ? BagPoses::Tf : BagPoses::Topic;
}

std::filesystem::path folderOf(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

/// Returns true for one of several files of a recording of rosbag2.
bool isPartOfRecording(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path folder = folderOf(path);
  return std::filesystem::exists(folder / "metadata.yaml", error) && !std::filesystem::is_directory(path, error) &&
         findRecordingFiles(folder).files.size() > 1;
}

std::shared_ptr<const ScanFile> openRecording(const std::filesystem::path& path, const OpenOptions& options) {
  const RecordingOptions& recording = options.files.recording;
  BagOptions bag;
  bag.topic = recording.topic;
  bag.poses = bagPosesOf(options);
  bag.pose_topic = recording.poses;
  bag.pose_frame = recording.pose_frame;
  bag.fixed_frame = recording.fixed_frame;
  bag.max_time_gap = options.max_time_gap;
  bag.log_times = recording.log_times;
  bag.has_extrinsic = options.has_extrinsic;
  bag.points_in_map = options.points_in_map;
  const std::string folder = isPartOfRecording(path) ? folderOf(path).string() : "";
  try {
    std::shared_ptr<const ScanFile> file = openBagScans(openMessageFile(path), path, bag);
    const MissingPoses missing = file->missingPoses();
    if (!folder.empty() && file->poseSource().empty() && !missing.reason.empty()) throw FileError(path, missing.reason);
    return file;
  } catch (const FileError& error) {
    if (folder.empty()) throw;
    const std::string text = error.what();
    throw FileError(path, text.substr(std::min(text.size(), path.string().size() + 2)) +
                              "; this is one file of the recording in " + folder + ": give the folder");
  }
}

/// Opens a file whose columns or fields the user names.
std::shared_ptr<const ScanFile> openWithFields(const std::filesystem::path& path, std::string_view start,
                                               const std::string& fields) {
  if (const std::string kind = kindOfStart(start); !kind.empty())
    throw FileError(path,
                    "is " + kind + ": only text files and raw records (.bin) have fields to name; leave out --fields");
  if (start.empty() || looksLikeText(start) || isCloudText(start)) return openCloudText(path, {fields});
  return openFloatRecords(path, {fields});
}

/// Returns true if the expanded text of a gzip file starts like a log of CARMEN.
bool isCarmenGzip(const std::filesystem::path& path, std::string_view bytes) {
  try {
    return isCarmenText(gunzipStart(path, bytes, kStart));
  } catch (const FileError&) {
    return false;  // damaged: the reader of another kind reports it
  }
}

/// Only PCD files and logs of CARMEN are read while they are compressed with gzip.
std::shared_ptr<const ScanFile> openGzip(const std::filesystem::path& path, std::string_view bytes) {
  if (isCarmenLogName(path) || isCarmenGzip(path, bytes)) return openCarmenScans(path);
  const std::string name = path.filename().string();
  if (name.find(".tar.") != std::string::npos || path.extension() == ".tgz")
    throw FileError(path, "is an archive (tar, gzip); expand it with tar xzf");
  const std::string extension = scanExtension(path.stem());
  if ((extension.empty() && !isTextName(path.stem())) || extension == ".pcd") return openPcd(path);
  throw FileError(
      path, "is compressed with gzip; expand it with gunzip (only PCD files and CARMEN logs can stay compressed)");
}

/// Returns true for a map file: an SQLite database with the application id of gaussmap.
bool isMapFile(std::string_view start) {
  constexpr std::size_t kApplicationId = 68;  // bytes from the start
  return start.size() > kApplicationId && start.substr(kApplicationId, 4) == "gmap";
}

/// Opens a file whose content is not that of a known kind. The name then decides whose message is the best.
std::shared_ptr<const ScanFile> openByName(const std::filesystem::path& path, std::string_view start) {
  const std::string extension = scanExtension(path.filename());
  if (extension == ".bin") return openFloatRecords(path);
  if (extension == ".pcd") return openPcd(path);
  if (start.empty()) throw FileError(path, "the file is empty");
  if (isMapFile(start)) throw FileError(path, "is a map, not a file of scans; gaussmap merge combines maps");
  if (const std::string kind = kindOfStart(start); !kind.empty())
    throw FileError(path, "is " + kind + ", not a file of scans");
  if (isRosbag2Metadata(start))
    throw FileError(path, "describes a recording of rosbag2; give the folder with the recording instead");
  if (isCarmenLogName(path) && looksLikeText(start)) return openCarmenScans(path);
  const bool is_utf16 = start[0] == '\xFF' || start[0] == '\xFE';
  if (looksLikeText(start) || is_utf16 || isTextName(path) || extension == ".xyz" || extension == ".pts" ||
      extension == ".ptx")
    return openCloudText(path);
  throw FileError(path,
                  "is not a kind of file that gaussmap reads (PCD, PLY, LAS, LAZ, E57, text, MCAP, bags of ROS); if it "
                  "holds raw numbers, name their fields, for example with --fields \"x y z intensity\"");
}

}  // namespace

OpenOptions openOptions(const FindScansOptions& options) {
  return {options.files, options.poses.empty(), options.matching.max_time_gap, options.extrinsic.has_value(),
          options.frame == ScanFrame::Map};
}

std::shared_ptr<const ScanFile> openScanFile(const std::filesystem::path& path, const OpenOptions& options) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return openRecording(path, options);
  const MappedFile file(path);
  const std::string_view start = file.bytes().substr(0, kStart);
  if (const std::string& fields = options.files.fields; !fields.empty()) return openWithFields(path, start, fields);
  if (isPcd(start)) return openPcd(path);
  if (isE57(start)) return openE57(path);
  if (isLaz(start)) return openLaz(path);
  if (isLas(start)) return openLas(path);
  if (isPly(start)) return openPlyCloud(path);
  if (isMessageFile(path)) return openRecording(path, options);
  if (isGzip(start)) return openGzip(path, file.bytes());
  if (isCarmenText(start)) return openCarmenScans(path);
  if (isCloudText(start)) return openCloudText(path);
  return openByName(path, start);
}

}  // namespace gaussmap::detail
