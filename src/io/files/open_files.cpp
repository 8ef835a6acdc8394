// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/open_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstring>

namespace gaussmap::detail {

OpenFiles open_parts, mapped_files;

OpenFile* OpenFiles::freeEntry() {
  for (OpenFile* entry = first_; entry != nullptr; entry = entry->next) {
    OpenFile::State expected = OpenFile::kFree;
    if (entry->state.compare_exchange_strong(expected, OpenFile::kFilling)) return entry;
  }
  auto* const entry = new OpenFile;
  entry->state = OpenFile::kFilling;
  entry->next = first_;
  while (!first_.compare_exchange_weak(entry->next, entry)) {
  }
  return entry;
}

OpenFile* OpenFiles::add(const std::filesystem::path& path, int file, std::string_view mapped) {
  OpenFile* const entry = freeEntry();
  std::strncpy(entry->path, path.c_str(), sizeof entry->path - 1);  // the path of an open file is not longer
  entry->file = file;
  entry->process = ::getpid();
  entry->begin = mapped.data();
  entry->bytes = mapped.size();
  entry->state = OpenFile::kOpen;
  return entry;
}

bool hasName(int file, const char* path) {
  struct stat open_one, named_one;
  return ::fstat(file, &open_one) == 0 && ::lstat(path, &named_one) == 0 && open_one.st_dev == named_one.st_dev &&
         open_one.st_ino == named_one.st_ino;
}

}  // namespace gaussmap::detail
