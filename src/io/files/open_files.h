// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <atomic>
#include <climits>
#include <cstddef>
#include <filesystem>
#include <string_view>

namespace gaussmap::detail {

/// What a signal handler must know of a file in work.
struct OpenFile {
  enum State { kFree, kFilling, kOpen };
  std::atomic<State> state{kFree};
  OpenFile* next = nullptr;
  char path[PATH_MAX] = {};
  int file = -1;      ///< its descriptor
  pid_t process = 0;  ///< whose it is: a child process has the list of its parent
  const char* begin = nullptr;
  std::size_t bytes = 0;  ///< mapped from `begin` on
};

/// A list that a signal handler can walk at any moment: entries are used again, but never freed.
class OpenFiles {
 public:
  constexpr OpenFiles() = default;
  OpenFile* add(const std::filesystem::path& path, int file, std::string_view mapped = {});
  static void remove(OpenFile* entry) { entry->state = OpenFile::kFree; }

  /// Calls body(entry) for all that are open. Safe in a signal handler if the body is.
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
extern OpenFiles open_parts;
/// Files that are mapped into memory.
extern OpenFiles mapped_files;

/// Is the open file still the one with this name? Safe in a signal handler.
bool hasName(int file, const char* path);

}  // namespace gaussmap::detail
