// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>

#include "io/bags/chunk_store.h"
#include "io/bags/message_index.h"

// The records of MCAP: one byte with the kind, the size of the content in 64 bits, and the content.
namespace gaussmap::detail {

inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);
inline constexpr std::size_t kMcapRecordHead = 9;
inline constexpr std::size_t kMcapMessageHead = 22;  ///< bytes of the content of a Message record before the data

namespace mcap {
enum Kind : std::uint8_t {
  Header = 0x01,
  Footer = 0x02,
  Schema = 0x03,
  ChannelInfo = 0x04,
  Message = 0x05,
  Chunk = 0x06,
  MessageIndexes = 0x07,
  Statistics = 0x0B,
  DataEnd = 0x0F
};
}  // namespace mcap

struct McapRecord {
  std::uint8_t kind = 0;
  std::string_view content;
  std::uint64_t size = 0;  ///< of the content, as announced
};

/// Reads the record at `place`. Returns false if it does not fit into the bytes; `record` then holds the part that
/// fits.
bool readMcapRecord(std::string_view bytes, std::uint64_t place, McapRecord& record);

struct McapMessage {
  std::uint32_t channel = 0;
  std::chrono::nanoseconds log_time{0};
  std::string_view data;
};

/// Reads the content of a Message record. Returns false if it is too short.
bool readMcapMessage(std::string_view content, McapMessage& message);

/// Reads the records that describe the messages, and adds what they say to an index. The functions throw FileError with
/// the place: the record is at byte `offset` of a chunk, or of the file if `chunk` is 0.
class McapDefinitions {
 public:
  McapDefinitions(const ChunkStore& store, MessageIndex& index) : store_(store), index_(index) {}

  void addSchema(std::string_view content, std::size_t chunk, std::uint64_t offset);
  void addChannel(std::string_view content, std::size_t chunk, std::uint64_t offset);
  void addMessage(std::string_view content, std::size_t chunk, std::uint64_t offset);
  /// Adds all records of a chunk.
  void addChunk(std::size_t chunk, std::string_view bytes);

 private:
  [[noreturn]] void failShort(const char* record, std::size_t chunk, std::uint64_t offset) const;
  const ChunkStore& store_;
  MessageIndex& index_;
  std::unordered_map<std::uint16_t, std::string> schemas_;
};

}  // namespace gaussmap::detail
