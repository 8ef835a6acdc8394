// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>

#include "gaussmap/core/error.h"

namespace gaussmap::detail {

struct OpenFile;

/// A file that appears whole or not at all. It is written as `<target>.part` beside the target, then renamed over
/// it: readers see the old file or the new one, whatever happens in between. One writer at a time: the part file is
/// locked. A part file left by a process that died is not locked, and is taken over; handleSignals() removes it.
class AtomicFile {
 public:
  /// Opens the part file, empty. A target that is a symbolic link is followed, the link stays.
  /// Throws FileError if the target is no file or a link to nowhere, if the folder cannot be written, or if somebody
  /// else is writing the same target at this moment.
  explicit AtomicFile(const std::filesystem::path& target);
  /// Without commit() the part file is removed, the target untouched.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& target() const { return target_; }
  /// For a library that writes files itself (SQLite): let it fill this file, close it, then call commit().
  /// It must write into the file, not replace it by another.
  const std::filesystem::path& partPath() const { return part_; }

  /// Appends bytes, unbuffered: hand over large pieces. Throws FileError if they do not all arrive (disk full).
  void write(const void* data, std::size_t bytes);

  /// Makes the part file the target: data to the disk, rename, folder to the disk. Throws FileError if a step fails;
  /// the target is then the old one, unless only the last step failed. Nothing can be written afterwards.
  void commit();

 private:
  bool openLocked();
  void closeFile() noexcept;
  [[noreturn]] void fail(const char* doing, int error) const;

  std::filesystem::path target_;
  std::filesystem::path part_;
  int file_ = -1;              // -1: committed
  OpenFile* entry_ = nullptr;  // what a signal handler sees, see handleSignals()
};

}  // namespace gaussmap::detail
