// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

namespace gaussmap::detail {

/// Bytes that wait on the disk: a file without a name, which is gone with the process, however that ends.
class SpillFile {
 public:
  /// Where some bytes stand.
  struct Span {
    std::uint64_t begin = 0;
    std::uint64_t size = 0;
  };

  /// In this folder. Throws FileError if no file can be made there.
  explicit SpillFile(const std::filesystem::path& folder);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  /// Throws FileError if the disk is full.
  Span append(const std::string& bytes);
  /// From any thread.
  std::string read(const Span& span) const;

 private:
  [[noreturn]] void fail(const char* doing, int error) const;

  std::filesystem::path folder_;
  int file_ = -1;
  std::uint64_t end_ = 0;
};

/// Appends an array of plain values to bytes that takeArray() reads again in the same program.
template <typename Value>
void putArray(std::string& bytes, const std::vector<Value>& values) {
  const std::uint64_t count = values.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
}

/// Appends the array at `place` to the values, and moves behind it.
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
