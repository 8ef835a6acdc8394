// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include "gaussmap/version.h"

namespace gaussmap {

/// Reports a file that cannot be used. The message has the form "path: reason". If the problem is at one place of the
/// file, the reason often gives its line number or byte offset.
class GAUSSMAP_API FileError : public std::runtime_error {
 public:
  /// Makes the message "path: what".
  FileError(const std::filesystem::path& path, const std::string& what)
      : std::runtime_error(path.string() + ": " + what) {}
};

}  // namespace gaussmap
