// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "gaussmap/version.h"

namespace gaussmap::detail {

struct OpenFile;

/// The bytes of a regular file, mapped read-only as long as the object lives.
class GAUSSMAP_API MappedFile {
 public:
  /// Maps a file. Throws FileError if it does not exist, is a directory, a pipe or a device, or cannot be read.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }
  /// Throws FileError if the file was truncated since it was opened: some of the bytes read are then zeros. Call it
  /// after the last byte has been read. (Reading a whole page that is gone raises SIGBUS, see handleSignals().)
  void requireWhole() const;
  /// Gives the memory of a part of bytes() back to the operating system, because it will hardly be read again. If it is
  /// read, the bytes come from the file again. Otherwise a process that reads many files seems to need their whole
  /// size.
  void release(std::string_view part) const;
  /// Does the same for all bytes.
  void release() const { release(bytes_); }

 private:
  std::filesystem::path path_;
  std::uint64_t device_ = 0, inode_ = 0;
  OpenFile* entry_ = nullptr;  // entry for the signal handler
  std::string_view bytes_;
};

}  // namespace gaussmap::detail
