// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/recording.h"

#include <algorithm>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "gaussmap/core/error.h"
#include "io/bags/compression.h"
#include "io/bags/mcap_file.h"
#include "io/bags/ros1_bag.h"
#include "io/bags/rosbag2_database.h"
#include "io/files/mapped_file.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kStart = 100;  // bytes that tell the kind of a file

/// Returns the first bytes of a regular file; empty if it cannot be read.
std::string startOf(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return "";
  std::string bytes(kStart, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

/// The expanded file of a compressed recording can be removed at once: it is open.
std::unique_ptr<MessageFile> openPlain(const fs::path& path, const fs::path& shown, std::string_view start) {
  if (isMcap(start)) return openMcap(path, shown);
  if (isRos1Bag(start)) return openRos1Bag(path, shown);
  if (isSqliteWithoutApplicationId(start)) return openRosbag2Database(path, shown);
  throw FileError(shown, start.empty() ? "the file is empty: the recording was not started, or not copied"
                                       : "is not a recording: it starts with " + quote(start.substr(0, 16)) +
                                             ", expected an MCAP file, a database of rosbag2 or a bag of ROS 1");
}

bool isPlainRecording(const fs::path& path, std::string_view start) {
  if (isMcap(start) || isRos1Bag(start)) return true;
  return isSqliteWithoutApplicationId(start) && (path.extension() == ".db3" || hasRosbag2Tables(path));
}

}  // namespace

std::unique_ptr<MessageFile> openRecordingFile(const fs::path& path) {
  const MappedFile file(path);  // says what is wrong with a path that is not a file
  if (!isZstd(file.bytes())) return openPlain(path, path, file.bytes().substr(0, kStart));
  const ExpandedFile expanded(path);
  const MappedFile content(expanded.path());
  return openPlain(expanded.path(), path, content.bytes().substr(0, kStart));
}

std::unique_ptr<MessageFile> openMessageFile(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return openRecordingFile(path);
  RecordingFolder folder = findRecordingFiles(path);
  std::vector<std::unique_ptr<MessageFile>> files;
  std::vector<std::string> names;
  for (const fs::path& file : folder.files) {
    if (fs::file_size(file, error) == 0 && !error && folder.files.size() > 1) {
      folder.warnings.push_back(file.filename().string() + " is empty: the recording was not finished");
      continue;
    }
    files.push_back(openRecordingFile(file));
    names.push_back(file.filename().string());
  }
  if (files.empty()) throw FileError(path, "all files of the recording are empty");
  return joinRecordings(std::move(files), names, std::move(folder.warnings));
}

bool isMessageFile(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return isRecordingFolder(path);
  const std::string start = startOf(path);
  if (!isZstd(start)) return isPlainRecording(path, start);
  try {
    const std::string expanded = expandStart(MappedFile(path).bytes(), kStart);
    return isMcap(expanded) || isRos1Bag(expanded) || isSqliteWithoutApplicationId(expanded);
  } catch (const FileError&) {
    return false;
  }
}

}  // namespace gaussmap::detail
