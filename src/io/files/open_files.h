// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <atomic>
#include <climits>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// The data of an open file that a signal handler needs.
struct OpenFile {
  enum State { kFree, kFilling, kOpen };
  std::atomic<State> state{kFree};
  OpenFile* next = nullptr;
  char path[PATH_MAX] = {};
  int file = -1;      ///< descriptor of the file; -1: mapped
  pid_t process = 0;  ///< process that opened the file: a child process also has the list of its parent
  const char* begin = nullptr;
  std::size_t bytes = 0;  ///< number of bytes mapped at `begin`
};

/// A list that a signal handler can read at any time: entries are reused, but never freed.
class OpenFiles {
 public:
  constexpr OpenFiles() = default;
  OpenFile* add(const std::filesystem::path& path, int file, std::string_view mapped = {});
  static void remove(OpenFile* entry) { entry->state = OpenFile::kFree; }

  /// Calls body(entry) for every open file. This is safe in a signal handler if the body is.
  template <typename Body>
  void forEach(const Body& body) const {
    for (const OpenFile* entry = first_; entry != nullptr; entry = entry->next)
      if (entry->state == OpenFile::kOpen) body(*entry);
  }

 private:
  OpenFile* freeEntry();
  std::atomic<OpenFile*> first_{nullptr};
};

/// Part files of AtomicFile.
GAUSSMAP_API extern OpenFiles open_parts;
/// Files that are mapped into memory.
GAUSSMAP_API extern OpenFiles mapped_files;

/// Returns true if the open file still has this name. Safe in a signal handler.
GAUSSMAP_API bool hasName(int file, const char* path);

}  // namespace gaussmap::detail
