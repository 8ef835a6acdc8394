// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/bags/chunk_store.h"
#include "io/formats/message_file.h"

namespace gaussmap::detail {

/// Returns "sensor_msgs/PointCloud2" for "sensor_msgs/msg/PointCloud2"; other names are not changed.
std::string typeName(std::string_view type);

/// Returns a time since 1970 for the messages. A time after the year 2262 becomes the last time that fits.
std::chrono::nanoseconds logTime(std::uint64_t nanoseconds);

/// A channel of MCAP or a connection of ROS 1: the messages of one sender.
struct Channel {
  std::string topic;
  std::string type;
  MessageEncoding encoding = MessageEncoding::Other;
};

/// Collects the channels and the places of the messages while a file is read, and turns them into topics and messages.
///
/// The index records of a file are used if their channels are known, and if they have as many messages as the file
/// claims. Otherwise the chunks are expanded and read.
class MessageIndex {
 public:
  explicit MessageIndex(const ChunkStore& store) : store_(&store) {}

  /// Adds a channel. Throws FileError if the number has another meaning already, or if there are too many channels.
  /// `chunk` and `offset` are for the error.
  void define(std::uint32_t number, Channel channel, std::size_t chunk, std::uint64_t offset);
  /// Adds a message: byte `offset` of a chunk, or of the file if `chunk` is 0. Throws FileError if there are more than
  /// one million messages plus one per byte of the file.
  void add(std::uint32_t channel, std::chrono::nanoseconds time, std::size_t chunk, std::uint64_t offset);
  /// Marks a chunk as described by index records.
  void markIndexed(std::size_t chunk);
  /// Marks a chunk as not described by index records, because they are damaged.
  void distrust(std::size_t chunk);

  /// Reads the records of a chunk: calls define() and add(). Throws FileError if they are damaged.
  using ReadChunk = std::function<void(std::size_t chunk, std::string_view bytes)>;
  /// Completes the messages. `counted` is the number of messages that the file claims to have; -1: unknown. Chunks
  /// without a reliable index are read. If a chunk is damaged, its messages are missing, and there is a warning.
  void finish(std::int64_t counted, const ReadChunk& read_chunk);

  const std::vector<MessageTopic>& topics() const { return topics_; }
  const std::vector<MessagePlace>& messages() const { return messages_; }
  std::vector<std::string>& warnings() { return warnings_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

  static std::size_t chunkOf(const MessagePlace& message) {
    return static_cast<std::size_t>(message.place >> kOffsetBits);
  }
  static std::uint64_t offsetOf(const MessagePlace& message) {
    return message.place & ((std::uint64_t{1} << kOffsetBits) - 1);
  }
  /// Throws FileError if the message at a place is not the one that the index names.
  void requireSame(const MessagePlace& expected, std::uint32_t channel, std::chrono::nanoseconds time) const;

 private:
  static constexpr int kOffsetBits = 40;
  void sortByPlace();
  void readChunk(std::size_t chunk, const ReadChunk& read_chunk);
  void readChunks(const ReadChunk& read_chunk);
  void compareCount(std::uint64_t counted, const ReadChunk& read_chunk);
  void reportDamage();
  void makeTopics();

  const ChunkStore* store_;
  std::map<std::uint32_t, Channel> channels_;
  std::unordered_map<std::uint32_t, std::size_t> topic_of_channel_;
  std::vector<bool> indexed_;           // for each chunk: it has index records
  std::vector<bool> read_;              // for each chunk: it was read, so its index records are not used
  std::vector<MessagePlace> messages_;  // before makeTopics(), `topic` is the number of the channel
  std::vector<MessageTopic> topics_;
  std::vector<std::string> warnings_;
  std::size_t damaged_chunks_ = 0;
  std::string first_damage_;
};

}  // namespace gaussmap::detail
