// SPDX-License-Identifier: BSD-3-Clause
// header only
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include "gaussmap/version.h"

namespace gaussmap {

/// A file that cannot be used, and why: "path: what", with the line or the byte where that helps.
class GAUSSMAP_API FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& path, const std::string& what)
      : std::runtime_error(path.string() + ": " + what) {}
};

}  // namespace gaussmap
