// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "io/bags/chunk_store.h"
#include "io/bags/message_index.h"

// The records of ROS 1 bags: a header of fields "name=value", and data. The size of each is stored in 32 bits.
namespace gaussmap::detail {

namespace ros1 {
enum Kind : std::uint8_t {
  MessageData = 0x02,
  BagHeader = 0x03,
  IndexData = 0x04,
  Chunk = 0x05,
  ChunkInfo = 0x06,
  Connection = 0x07
};
}  // namespace ros1

struct Ros1Record {
  std::uint8_t kind = 0;    ///< 0: the header has no field "op"
  std::string_view header;  ///< the fields
  std::string_view data;
  std::uint64_t size = 0;  ///< of the data, as announced
  std::size_t bytes = 0;   ///< size of the whole record
};

/// Reads the record at `place`. Returns false if it does not fit into the bytes; `record` then holds the part that
/// fits.
bool readRos1Record(std::string_view bytes, std::uint64_t place, Ros1Record& record);

/// Returns true if the bytes have a field with this name, and stores its value.
bool findRos1Field(std::string_view fields, std::string_view name, std::string_view& value);

/// Returns true if the bytes have a field with this name and this size, and stores its value.
template <typename Number>
bool findRos1Number(std::string_view fields, std::string_view name, Number& number) {
  std::string_view value;
  if (!findRos1Field(fields, name, value) || value.size() != sizeof(Number)) return false;
  std::memcpy(&number, value.data(), sizeof(Number));
  return true;
}

/// Returns a time of ROS 1: the seconds are in the low 32 bits, the nanoseconds in the high ones.
std::chrono::nanoseconds ros1Time(std::uint64_t time);

struct Ros1Message {
  std::uint32_t connection = 0;
  std::chrono::nanoseconds time{0};
};

/// Reads the header of a message. Returns false if a field is missing.
bool readRos1Message(const Ros1Record& record, Ros1Message& message);

/// Adds what a record says to the index. The functions throw FileError with the place: the record is at byte `offset`
/// of a chunk, or of the file if `chunk` is 0.
void addRos1Connection(const ChunkStore& store, MessageIndex& index, const Ros1Record& record, std::size_t chunk,
                       std::uint64_t offset);
void addRos1Message(const ChunkStore& store, MessageIndex& index, const Ros1Record& record, std::size_t chunk,
                    std::uint64_t offset);
/// Adds all records of a chunk.
void addRos1Chunk(const ChunkStore& store, MessageIndex& index, std::size_t chunk, std::string_view bytes);

}  // namespace gaussmap::detail
