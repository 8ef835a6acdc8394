// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/bags/compression.h"
#include "io/files/mapped_file.h"

namespace gaussmap::detail {

/// A compressed piece of a recording.
struct Chunk {
  std::size_t byte = 0;     ///< place of its record in the file
  std::string_view packed;  ///< in the mapped file
  std::uint64_t size = 0;   ///< expanded
  Compression compression = Compression::None;
  std::uint32_t crc = 0;  ///< CRC-32 of the expanded bytes; 0: unknown
};

/// Expanded bytes. They are valid while both the object and the store exist.
struct ChunkBytes {
  std::string_view bytes;
  std::shared_ptr<const char[]> owner;
};

/// A mapped file and its chunks, which are expanded when they are needed. The most recently used chunks are kept, up to
/// 16 MiB, but at least one; up to 512 MiB if messages of many chunks are interleaved in time. bytes() is thread-safe.
class ChunkStore {
 public:
  /// Maps a file. `shown` is its path in messages.
  ChunkStore(const std::filesystem::path& path, std::filesystem::path shown);

  std::string_view file() const { return file_.bytes(); }
  const std::filesystem::path& path() const { return shown_; }
  std::size_t chunks() const { return chunks_.size() - 1; }

  /// Adds a chunk and returns its number, from 1. Throws FileError if its size is not plausible: a chunk can expand to
  /// maxExpanded() of its size, and all chunks together to 512 MiB plus 200 times the size of the file.
  std::size_t add(const Chunk& chunk);
  const Chunk& chunk(std::size_t number) const { return chunks_[number]; }

  /// Returns the expanded bytes of a chunk, or those of the whole file if `number` is 0. Throws FileError if they are
  /// damaged.
  ChunkBytes bytes(std::size_t number) const;
  /// Returns the first bytes of a chunk: at least `least`, or all if it has fewer. Does not verify the CRC. If few
  /// bytes are needed, this function is much faster than bytes(). Throws FileError if they are damaged.
  ChunkBytes start(std::size_t number, std::uint64_t least) const;
  /// Returns the number of expanded bytes of a chunk, or the size of the file if `number` is 0.
  std::uint64_t size(std::size_t number) const { return number == 0 ? file().size() : chunk(number).size; }

  /// Says that a part of the file was read, and is hardly needed again. From time to time, the memory of such parts is
  /// given back to the operating system. Views of other memory are ignored.
  void finishedWith(std::string_view part) const;

  /// Throws FileError with a place: byte `offset` of a chunk, or of the file if `number` is 0.
  [[noreturn]] void fail(std::size_t number, std::uint64_t offset, const std::string& what) const;
  /// Returns "byte 17 of the chunk at byte 4096", or "byte 17" if `number` is 0.
  std::string placeOf(std::size_t number, std::uint64_t offset) const;

 private:
  struct Slot {
    std::mutex filling;
    std::shared_ptr<const char[]> bytes;
    bool checked = false;
    std::shared_ptr<const char[]> start;  // only the first bytes
    std::size_t start_size = 0;
  };
  using Kept = std::list<std::pair<std::size_t, std::shared_ptr<Slot>>>;

  std::shared_ptr<Slot> slotOf(std::size_t number) const;
  std::shared_ptr<const char[]> expanded(const Chunk& chunk) const;
  bool expandStart(const Chunk& chunk, std::uint64_t least, Slot& slot) const;
  void check(const Chunk& chunk, std::string_view bytes) const;

  std::filesystem::path shown_;
  MappedFile file_;
  std::vector<Chunk> chunks_;
  std::uint64_t total_ = 0;
  mutable std::mutex mutex_;  // of the members below
  mutable Kept kept_;         // the most recently used chunk comes first
  mutable std::unordered_map<std::size_t, Kept::iterator> places_;
  mutable std::uint64_t kept_bytes_ = 0;
  mutable std::uint64_t keep_bytes_ = std::uint64_t{16} << 20;
  mutable std::unordered_map<std::size_t, std::uint64_t> dropped_;  // value of drops_ when a chunk was dropped
  mutable std::uint64_t drops_ = 0;
  mutable std::uint64_t returns_ = 0;  // of chunks that had just been dropped
  mutable std::mutex finished_mutex_;
  mutable std::string_view finished_;  // from the first to the last part that was read
  mutable std::size_t finished_bytes_ = 0;
};

}  // namespace gaussmap::detail
