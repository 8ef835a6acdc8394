// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>

#include "gaussmap/core/error.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

struct OpenFile;

/// Writes a file atomically. The content goes to `<target>.part` beside the target, which is then renamed to the
/// target: readers see either the old or the new file, also after a crash.
///
/// There is one writer at a time, because the part file is locked. The part file of a process that died is not locked,
/// and the next writer reuses it. After handleSignals(), a signal that ends the process also removes it.
class GAUSSMAP_API AtomicFile {
 public:
  /// Opens the part file and empties it. If the target is a symbolic link, the file that it points to is replaced and
  /// the link stays. Throws FileError if the target is not a regular file or is a broken link, if the folder cannot be
  /// written, or if another writer is writing the same target.
  explicit AtomicFile(const std::filesystem::path& target);
  /// Removes the part file if there was no commit(). The target is then unchanged.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& target() const { return target_; }
  /// Returns the path for a library that writes files itself (SQLite). The library fills this file and closes it; then
  /// call commit(). It must write into the file, and must not replace it by another one.
  const std::filesystem::path& partPath() const { return part_; }

  /// Appends bytes without buffering, so pass large pieces. Throws FileError if they cannot all be written (disk full).
  void write(const void* data, std::size_t bytes);

  /// Makes the part file the target: syncs the data to the disk, renames the file, and syncs the folder. Afterwards
  /// nothing can be written. Throws FileError if a step fails. The target is then the old file, unless only the
  /// last step failed.
  void commit();

 private:
  bool openLocked();
  void closeFile() noexcept;
  [[noreturn]] void fail(const char* doing, int error) const;

  std::filesystem::path target_;
  std::filesystem::path part_;
  int file_ = -1;              // -1: committed
  OpenFile* entry_ = nullptr;  // entry for the signal handler, see handleSignals()
};

}  // namespace gaussmap::detail
