// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "gaussmap/core/error.h"

namespace gaussmap::fuzz {

/// Writes the bytes to a file with this name and returns its path. The file is the same each time, in memory
/// (/dev/shm) if possible.
inline std::filesystem::path asFile(const char* name, const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = [] {
    std::string made =
        std::filesystem::exists("/dev/shm") ? "/dev/shm" : std::filesystem::temp_directory_path().string();
    made += "/gaussmap_fuzz_XXXXXX";
    if (mkdtemp(made.data()) == nullptr) std::abort();
    static struct Remover {
      std::filesystem::path path;
      ~Remover() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
      }
    } remover{made};
    return std::filesystem::path(made);
  }();
  const std::filesystem::path path = folder / name;
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return path;
}

/// Calls a reader. It may refuse the file with FileError; any other exception is a finding, like a crash.
template <typename Read>
void refusesOrReads(const Read& read) {
  try {
    read();
  } catch (const FileError&) {
  }
}

}  // namespace gaussmap::fuzz
