// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/version.h"
#include "io/formats/message_file.h"
#include "io/messages/wire_reader.h"

namespace gaussmap::detail {

/// Returns a time of a recording, limited to the range in which differences do not overflow.
std::chrono::nanoseconds safeTime(std::chrono::nanoseconds time);

/// Returns the origin of a message.
MessageOrigin originOf(const std::filesystem::path& path, const MessageFile& file, const MessagePlace& message);

/// The topics of a recording with the same name and type. ROS 1 lists a topic once per node that publishes it.
struct TopicGroup {
  std::string name;
  std::string type;
  std::size_t messages = 0;
  bool is_readable = true;           ///< the encoding is known
  std::vector<std::size_t> indices;  ///< of the topics
};

/// Returns the topics of a recording, in the order of the file.
std::vector<TopicGroup> groupTopics(const MessageFile& file);

/// Returns topics for a message: "/points (sensor_msgs/PointCloud2, 120 messages), /imu (...)".
std::string listTopics(const std::vector<TopicGroup>& topics);

/// Returns the topic with the scans: the one with this name, or, if the name is empty, the only topic of
/// sensor_msgs/PointCloud2, else of sensor_msgs/LaserScan, else of sensor_msgs/PointCloud. Topics without messages do
/// not count. A slash in front of the name may be missing. Throws FileError that lists the topics.
TopicGroup chooseScanTopic(const std::filesystem::path& path, const MessageFile& file,
                           const std::vector<TopicGroup>& topics, const std::string& name);

/// One topic of a recording, for a table.
struct BagTopicSummary {
  std::string name, type;
  std::size_t messages = 0;
  std::optional<std::chrono::nanoseconds> first, last;  ///< times of recording
  std::string frame;                                    ///< frame_id of the first message; empty: unknown
};

/// The topics of a recording.
struct BagSummary {
  std::string kind;  ///< as MessageFile::kind()
  std::vector<BagTopicSummary> topics;
  std::vector<std::string> warnings;  ///< of the recording, and of first messages that are damaged
};

/// Reads the index and the first message of each topic that has a header.
GAUSSMAP_API BagSummary bagSummary(const MessageFile& file, const std::filesystem::path& path);

}  // namespace gaussmap::detail
