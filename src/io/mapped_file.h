// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

namespace gaussmap {

/// A regular file's bytes, read-only, mapped for as long as the object lives.
class MappedFile {
 public:
  /// Throws FileError if there is no such file, or it is a directory, a pipe, a device, or may not be read.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }

 private:
  std::string_view bytes_;
};

}  // namespace gaussmap
