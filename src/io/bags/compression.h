// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gaussmap::detail {

enum class Compression { None, Zstd, Lz4, Bz2 };

/// Returns "zstd", "lz4", "bz2", or "none".
std::string nameOf(Compression compression);

/// Returns the maximum size to which so many bytes may expand: 64 MiB plus 200 times their size. The limit keeps a
/// small file from filling the memory.
std::uint64_t maxExpanded(std::uint64_t packed);

/// Expands bytes to exactly `size` bytes at `target`. `compression` must not be None. Returns an empty string, or what
/// is wrong with the bytes. `room_behind` is the number of bytes behind the target that may be changed: with
/// roomBehind(), some libraries need no copy of their own.
std::string expand(Compression compression, std::string_view packed, char* target, std::size_t size,
                   std::size_t room_behind = 0);
std::size_t roomBehind(Compression compression);

/// Expands only the first `size` bytes. Returns false if that is not possible: the bytes can be damaged, or written in
/// a way that needs much memory for this.
bool expandFirst(Compression compression, std::string_view packed, char* target, std::size_t size);

inline constexpr std::size_t kZstdMagicBytes = 4;
/// Returns true if the bytes start like a zstd frame.
bool isZstd(std::string_view bytes);

/// Expands a message that rosbag2 has compressed by itself (compression_mode: message). Returns an empty string, or
/// what is wrong with the bytes.
std::string expandMessage(std::string_view packed, std::vector<char>& message);

/// Returns the first bytes of a zstd file, at most `length`; less if it is damaged or shorter.
std::string expandStart(std::string_view packed, std::size_t length);

/// A temporary file with the content of a zstd file. The destructor removes the file.
class ExpandedFile {
 public:
  /// Expands a file into the folder for temporary files. Throws FileError if it is damaged, expands to more than 256
  /// MiB plus 200 times its size, or cannot be written.
  explicit ExpandedFile(const std::filesystem::path& packed);
  ~ExpandedFile();
  ExpandedFile(const ExpandedFile&) = delete;
  ExpandedFile& operator=(const ExpandedFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace gaussmap::detail
