// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// How the messages of a topic are written.
enum class MessageEncoding {
  Cdr,   ///< ROS 2: CDR with its four bytes of encapsulation
  Ros1,  ///< ROS 1: little-endian, without alignment
  Other
};

/// A topic of a recording.
struct MessageTopic {
  std::string name;  ///< "/points"
  std::string type;  ///< "sensor_msgs/PointCloud2", without "/msg/"
  MessageEncoding encoding = MessageEncoding::Other;
  std::size_t messages = 0;  ///< number of messages
};

/// Where a message is.
struct MessagePlace {
  std::size_t topic = 0;                 ///< index of the topic
  std::chrono::nanoseconds log_time{0};  ///< when it was recorded, since 1970
  std::uint64_t place = 0;               ///< used only by the MessageFile
};

/// The first bytes of a message.
struct MessageStart {
  std::vector<char> bytes;
  std::size_t size = 0;  ///< of the whole message
};

/// A recording of messages: an MCAP file, a bag of ROS 1, or a database of rosbag2. All functions are thread-safe.
///
/// Opening reads the index, or the whole file once if it has none because the recording was not finished. It does not
/// keep messages in memory. Readers throw FileError with the byte in the file, what was found, and what to do.
class MessageFile {
 public:
  virtual ~MessageFile() = default;

  /// Returns the kind of the recording: "MCAP (zstd)", "rosbag2 sqlite3", "ROS 1 bag (bz2)".
  virtual std::string kind() const = 0;
  virtual const std::vector<MessageTopic>& topics() const = 0;
  /// Returns the messages of all topics, in the order of their log times; equal times in the order of the file.
  virtual const std::vector<MessagePlace>& messages() const = 0;
  /// Returns the bytes of a message. Throws FileError if the data are damaged.
  virtual std::vector<char> read(const MessagePlace& message) const = 0;
  /// Returns the first bytes of a message: `most`, or all if it has fewer, or more if that is as easy. If the message
  /// is large, this function is much faster than read(), but does not verify checksums. Throws FileError if the data
  /// are damaged.
  virtual MessageStart readStart(const MessagePlace& message, std::size_t most) const;
  /// Returns warnings about the recording, one or two sentences each, for example "was not finished".
  virtual std::vector<std::string> warnings() const { return {}; }
};

inline MessageStart MessageFile::readStart(const MessagePlace& message, std::size_t /*most*/) const {
  MessageStart start;
  start.bytes = read(message);
  start.size = start.bytes.size();
  return start;
}

/// Opens a recording: a file, or a directory with metadata.yaml, whose files are read as one recording. The kind
/// follows from the content. Throws FileError.
GAUSSMAP_API std::unique_ptr<MessageFile> openMessageFile(const std::filesystem::path& path);

/// Returns true if the file or directory looks like a recording. Reads a few bytes.
GAUSSMAP_API bool isMessageFile(const std::filesystem::path& path);

}  // namespace gaussmap::detail
