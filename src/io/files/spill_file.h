// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// An anonymous temporary file. The system removes it when the process ends, also after a crash.
class GAUSSMAP_API SpillFile {
 public:
  /// Position of some bytes in the file.
  struct Span {
    std::uint64_t begin = 0;
    std::uint64_t size = 0;
  };

  /// Creates the file in this folder. Throws FileError if this fails.
  explicit SpillFile(const std::filesystem::path& folder);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  /// Appends bytes and returns their position. Throws FileError if they cannot be written (disk full).
  Span append(const std::string& bytes);
  /// Returns bytes of the file. Can be called from any thread. Throws FileError if they cannot be read.
  std::string read(const Span& span) const;

 private:
  [[noreturn]] void fail(const char* doing, int error) const;

  std::filesystem::path folder_;
  int file_ = -1;
  std::uint64_t end_ = 0;
};

/// Appends an array of trivially copyable values to `bytes`. takeArray() reads it again in the same program.
template <typename Value>
void putArray(std::string& bytes, const std::vector<Value>& values) {
  const std::uint64_t count = values.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
}

/// Reads an array at `place`, appends it to `values`, and moves `place` behind it.
template <typename Value>
void takeArray(const std::string& bytes, std::size_t& place, std::vector<Value>& values) {
  std::uint64_t count = 0;
  std::memcpy(&count, bytes.data() + place, sizeof count);
  place += sizeof count;
  const std::size_t first = values.size();
  values.resize(first + count);
  if (count > 0) std::memcpy(static_cast<void*>(values.data() + first), bytes.data() + place, count * sizeof(Value));
  place += count * sizeof(Value);
}

}  // namespace gaussmap::detail
