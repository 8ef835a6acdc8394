// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/formats/message_file.h"

namespace gaussmap::detail {

/// Returns true if a name ends like a recording: .mcap, .db3, .bag, and the first two with .zstd or .zst.
bool hasRecordingName(const std::filesystem::path& path);

/// Returns true for the text of a metadata.yaml of rosbag2.
inline bool isRosbag2Metadata(std::string_view text) {
  return text.find("rosbag2_bagfile_information") != std::string_view::npos;
}

/// The files of a recording in a directory.
struct RecordingFolder {
  std::vector<std::filesystem::path> files;  ///< in the order of their numbers
  std::vector<std::string> warnings;
};

/// Returns true if a directory has a metadata.yaml of rosbag2, or only files with the names of recordings.
bool isRecordingFolder(const std::filesystem::path& folder);

/// Finds the files of a recording. Throws FileError if no file is found.
RecordingFolder findRecordingFiles(const std::filesystem::path& folder);

/// Opens one file, by its content. Throws FileError.
std::unique_ptr<MessageFile> openRecordingFile(const std::filesystem::path& path);

/// Joins the files of a recording: topics with the same name, type and encoding become one. Throws FileError.
std::unique_ptr<MessageFile> joinRecordings(std::vector<std::unique_ptr<MessageFile>> files,
                                            const std::vector<std::string>& names, std::vector<std::string> warnings);

}  // namespace gaussmap::detail
