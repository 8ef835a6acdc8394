// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/io/scans/file_scans.h"

namespace gaussmap::app {

/// A scan or a map that is to be registered.
struct Subject {
  std::filesystem::path path;
  std::string name;                                             ///< of the scan in a file with several scans
  std::size_t index = 0;                                        ///< of the scan in its file
  bool is_map = false;                                          ///< a map in place of a scan
  std::optional<Pose> pose = std::nullopt;                      ///< from the file, not checked
  std::optional<std::chrono::nanoseconds> time = std::nullopt;  ///< from the file
  std::string error = "";                                       ///< why the file cannot be opened

  /// Returns the path, and the name if there is one, for messages.
  std::string label() const { return path.string() + (name.empty() ? "" : ": " + name); }
  /// The same with the file name in place of the path.
  std::string shortLabel() const { return path.filename().string() + (name.empty() ? "" : ": " + name); }
};

/// Opens the files and lists their scans. A file that cannot be opened becomes one subject with an error, unless it is
/// the only file: then the function throws FileError.
std::vector<Subject> subjectsIn(const std::vector<std::filesystem::path>& files, const FindScansOptions& options);

}  // namespace gaussmap::app
