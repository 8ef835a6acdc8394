// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "io/formats/message_file.h"
#include "io/pcd/pcd_bytes.h"

// Writes recordings for tests byte by byte, from the specifications of the formats.
namespace gaussmap::test {

inline std::uint32_t crcOf(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

/// Bytes after their number in 32 bits.
inline std::string counted(const std::string& bytes) {
  return bytesOf(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

namespace mcap {

inline const std::string kMagic("\x89MCAP0\r\n", 8);

inline std::string record(int kind, const std::string& content) {
  return std::string(1, static_cast<char>(kind)) + bytesOf(static_cast<std::uint64_t>(content.size())) + content;
}
inline std::string header() {
  return record(1, counted("ros2") + counted("test"));
}
inline std::string schema(std::uint16_t number, const std::string& name) {
  return record(3, bytesOf(number) + counted(name) + counted("ros2msg") + counted("text"));
}
inline std::string channel(std::uint16_t number, std::uint16_t schema, const std::string& topic,
                           const std::string& encoding = "cdr") {
  return record(4, bytesOf(number) + bytesOf(schema) + counted(topic) + counted(encoding) + counted(""));
}
inline std::string message(std::uint16_t channel, std::uint64_t time, const std::string& data) {
  return record(5, bytesOf(channel) + bytesOf(std::uint32_t{0}) + bytesOf(time) + bytesOf(time) + data);
}
/// A chunk whose bytes are compressed already, or not at all.
inline std::string chunk(const std::string& bytes, const std::string& compression = "", std::uint64_t size = ~0ull,
                         std::uint32_t crc = 0) {
  return record(6, bytesOf(std::uint64_t{0}) + bytesOf(std::uint64_t{0}) +
                       bytesOf(size == ~0ull ? std::uint64_t{bytes.size()} : size) + bytesOf(crc) +
                       counted(compression) + bytesOf(std::uint64_t{bytes.size()}) + bytes);
}
struct Entry {
  std::uint64_t time, offset;
};
inline std::string index(std::uint16_t channel, const std::vector<Entry>& entries) {
  std::string array;
  for (const Entry& entry : entries) array += bytesOf(entry.time) + bytesOf(entry.offset);
  return record(7, bytesOf(channel) + counted(array));
}
inline std::string statistics(std::uint64_t messages) {
  return record(11, bytesOf(messages) + std::string(2 + 4 * 4 + 8 + 8, '\0') + counted(""));
}
/// Returns a file with these records of the data and the summary.
inline std::string file(const std::string& data, const std::string& summary = "", std::uint32_t data_crc = 0) {
  std::string bytes = kMagic + header() + data;
  bytes += record(15, bytesOf(data_crc));
  const std::uint64_t start = bytes.size();
  const std::string footer = std::string(1, '\2') + bytesOf(std::uint64_t{20}) + bytesOf(summary.empty() ? 0 : start) +
                             bytesOf(std::uint64_t{0});
  return bytes + summary + footer + bytesOf(crcOf(summary + footer)) + kMagic;
}

}  // namespace mcap

namespace ros1 {

inline const std::string kMagic = "#ROSBAG V2.0\n";

inline std::string field(const std::string& name, const std::string& value) {
  return counted(name + "=" + value);
}
template <typename Number>
std::string number(const std::string& name, Number value) {
  return field(name, bytesOf(value));
}
inline std::string record(int op, const std::string& fields, const std::string& data) {
  return counted(fields + number("op", static_cast<std::uint8_t>(op))) + counted(data);
}
inline std::string bagHeader(std::uint64_t index_pos, std::uint32_t connections, std::uint32_t chunks,
                             const std::string& more = "") {
  return record(
      3, number("index_pos", index_pos) + number("conn_count", connections) + number("chunk_count", chunks) + more,
      std::string(20, ' '));
}
inline std::string connection(std::uint32_t number, const std::string& topic, const std::string& type) {
  return record(7, ros1::number("conn", number) + field("topic", topic),
                field("topic", topic) + field("type", type) + field("md5sum", "*") + field("message_definition", ""));
}
inline std::uint64_t time(std::uint32_t seconds, std::uint32_t nanoseconds) {
  return std::uint64_t{nanoseconds} << 32 | seconds;
}
inline std::string message(std::uint32_t connection, std::uint64_t time, const std::string& data) {
  return record(2, number("conn", connection) + number("time", time), data);
}
inline std::string chunk(const std::string& bytes, const std::string& compression = "none", std::uint32_t size = ~0u) {
  return record(
      5,
      field("compression", compression) + number("size", size == ~0u ? static_cast<std::uint32_t>(bytes.size()) : size),
      bytes);
}
struct Entry {
  std::uint64_t time;
  std::uint32_t offset;
};
inline std::string index(std::uint32_t connection, const std::vector<Entry>& entries, std::uint32_t version = 1) {
  std::string data;
  for (const Entry& entry : entries) data += bytesOf(entry.time) + bytesOf(entry.offset);
  return record(
      4,
      number("ver", version) + number("conn", connection) + number("count", static_cast<std::uint32_t>(entries.size())),
      data);
}
inline std::string chunkInfo(std::uint64_t place, std::uint32_t connection, std::uint32_t messages) {
  return record(6,
                number("ver", std::uint32_t{1}) + number("chunk_pos", place) + number("start_time", std::uint64_t{0}) +
                    number("end_time", std::uint64_t{0}) + number("count", std::uint32_t{1}),
                bytesOf(connection) + bytesOf(messages));
}

}  // namespace ros1

/// Returns a line per message: topic, time, size, CRC-32.
inline std::vector<std::string> listed(const detail::MessageFile& file) {
  std::vector<std::string> lines;
  for (const detail::MessagePlace& message : file.messages()) {
    const std::vector<char> data = file.read(message);
    char crc[16];
    std::snprintf(crc, sizeof crc, "%08x", crcOf({data.begin(), data.end()}));
    lines.push_back(file.topics().at(message.topic).name + " " + std::to_string(message.log_time.count()) + " " +
                    std::to_string(data.size()) + " " + crc);
  }
  return lines;
}

/// Expects that the starts of all messages, of several lengths, are those of the whole messages.
inline void expectStarts(const detail::MessageFile& file) {
  for (const detail::MessagePlace& message : file.messages()) {
    const std::vector<char> data = file.read(message);
    for (const std::size_t most : {std::size_t{0}, std::size_t{9}, data.size() / 2, data.size(), data.size() + 9}) {
      const detail::MessageStart start = file.readStart(message, most);
      EXPECT_EQ(start.size, data.size());
      ASSERT_GE(start.bytes.size(), std::min(most, data.size()));
      ASSERT_LE(start.bytes.size(), data.size());
      EXPECT_TRUE(std::equal(start.bytes.begin(), start.bytes.end(), data.begin()));
    }
  }
}

inline std::string textOf(const std::vector<char>& data) {
  return {data.begin(), data.end()};
}

/// Returns a line per message: topic, time, data.
inline std::vector<std::string> texts(const std::filesystem::path& path) {
  const auto file = detail::openMessageFile(path);
  std::vector<std::string> lines;
  for (const detail::MessagePlace& message : file->messages())
    lines.push_back(file->topics().at(message.topic).name + " " + std::to_string(message.log_time.count()) + " " +
                    textOf(file->read(message)));
  return lines;
}

/// Returns all warnings, a line each.
inline std::string warningsOf(const std::filesystem::path& path) {
  std::string lines;
  for (const std::string& warning : detail::openMessageFile(path)->warnings()) lines += warning + "\n";
  return lines;
}

}  // namespace gaussmap::test
