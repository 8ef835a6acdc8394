// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace gaussmap::detail {

struct OpenFile;

/// A regular file's bytes, read-only, mapped for as long as the object lives.
class MappedFile {
 public:
  /// Throws FileError if there is no such file, or it is a directory, a pipe, a device, or may not be read.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }
  /// Throws FileError if the file was cut off since it was opened: some of what was read are then zeros. To be asked
  /// when the last byte has been read. (Whole pages that are gone raise SIGBUS, see handleSignals().)
  void requireWhole() const;

 private:
  std::filesystem::path path_;
  std::uint64_t device_ = 0, inode_ = 0;
  OpenFile* entry_ = nullptr;  // what a signal handler sees
  std::string_view bytes_;
};

}  // namespace gaussmap::detail
