// SPDX-License-Identifier: BSD-3-Clause
#include "io/messages/bag_topics.h"

#include <algorithm>
#include <map>
#include <utility>

#include "io/messages/message_scans.h"
#include "io/messages/ros_messages.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kMostListed = 30;

std::string withoutSlash(const std::string& name) {
  return !name.empty() && name.front() == '/' ? name.substr(1) : name;
}

std::vector<TopicGroup> scanTopics(const std::vector<TopicGroup>& topics, const std::string& type) {
  std::vector<TopicGroup> found;
  for (const TopicGroup& topic : topics)
    if (topic.is_readable && topic.messages > 0 && (type.empty() ? isScanType(topic.type) : topic.type == type))
      found.push_back(topic);
  return found;
}

/// Returns what to do if a topic holds the packets of a lidar.
std::string packetHint(const std::vector<TopicGroup>& topics) {
  for (const TopicGroup& topic : topics)
    for (const char* const part : {"Packet", "VelodyneScan", "PandarScan", "rslidarScan", "livox", "LidarScan"})
      if (topic.messages > 0 && topic.type.find(part) != std::string::npos)
        return "; " + shown(topic.name) + " holds the packets of a lidar: its driver converts them to PointCloud2";
  return "";
}

}  // namespace

std::chrono::nanoseconds safeTime(std::chrono::nanoseconds time) {
  constexpr std::chrono::nanoseconds kLimit(std::int64_t{1} << 62);
  return std::clamp(time, -kLimit, kLimit);
}

MessageOrigin originOf(const std::filesystem::path& path, const MessageFile& file, const MessagePlace& message) {
  return {path, file.topics().at(message.topic).name, message.log_time};
}

std::vector<TopicGroup> groupTopics(const MessageFile& file) {
  std::vector<TopicGroup> groups;
  std::map<std::pair<std::string, std::string>, std::size_t> known;
  for (std::size_t i = 0; i < file.topics().size(); ++i) {
    const MessageTopic& topic = file.topics()[i];
    const bool is_readable = topic.encoding != MessageEncoding::Other;
    const auto [place, is_new] = known.emplace(std::pair(topic.name, topic.type), groups.size());
    if (is_new) groups.push_back({topic.name, topic.type, 0, is_readable, {}});
    TopicGroup& group = groups[place->second];
    group.messages += topic.messages;
    group.is_readable = group.is_readable && is_readable;
    group.indices.push_back(i);
  }
  return groups;
}

std::string listTopics(const std::vector<TopicGroup>& topics) {
  std::string text;
  for (std::size_t i = 0; i < std::min(topics.size(), kMostListed); ++i)
    text += (i > 0 ? ", " : "") + shown(topics[i].name) + " (" + shown(topics[i].type) + ", " +
            std::to_string(topics[i].messages) + (topics[i].messages == 1 ? " message)" : " messages)");
  if (topics.size() > kMostListed) text += " and " + std::to_string(topics.size() - kMostListed) + " more";
  return text.empty() ? "none" : text;
}

TopicGroup chooseScanTopic(const std::filesystem::path& path, const MessageFile& file,
                           const std::vector<TopicGroup>& topics, const std::string& name) {
  if (!name.empty()) {
    std::vector<TopicGroup> named;
    for (const TopicGroup& topic : topics)
      if (withoutSlash(topic.name) == withoutSlash(name)) named.push_back(topic);
    if (named.empty())
      throw FileError(
          path, "has no topic " + shown(name) + "; the topics with scans are " + listTopics(scanTopics(topics, "")));
    const auto usable = std::find_if(named.begin(), named.end(), [](const TopicGroup& topic) {
      return isScanType(topic.type) && topic.is_readable;
    });
    if (usable == named.end())
      throw FileError(path, "topic " + listTopics(named) +
                                " holds no scans that gaussmap can read, expected sensor_msgs/PointCloud2 or "
                                "sensor_msgs/LaserScan; the topics with scans are " +
                                listTopics(scanTopics(topics, "")));
    if (usable->messages == 0) throw FileError(path, "topic " + shown(usable->name) + " has no messages");
    return *usable;
  }
  for (const char* const type : {"sensor_msgs/PointCloud2", "sensor_msgs/LaserScan", "sensor_msgs/PointCloud"}) {
    const std::vector<TopicGroup> found = scanTopics(topics, type);
    if (found.size() == 1) return found.front();
    if (found.size() > 1)
      throw FileError(path, "has several topics with scans: " + listTopics(found) + "; choose one with --topic " +
                                shown(found.front().name));
  }
  std::string text = "has no messages of sensor_msgs/PointCloud2 or sensor_msgs/LaserScan; its topics are " +
                     listTopics(topics) + packetHint(topics);
  for (const TopicGroup& topic : topics)
    if (isScanType(topic.type) && topic.messages > 0 && !topic.is_readable)
      text += "; " + shown(topic.name) + " is written in an encoding that is not read (only CDR and that of ROS 1 are)";
  for (const std::string& warning : file.warnings()) text += "; " + warning;
  throw FileError(path, text);
}

BagSummary bagSummary(const MessageFile& file, const std::filesystem::path& path) {
  const std::vector<TopicGroup> groups = groupTopics(file);
  std::vector<std::size_t> group_of(file.topics().size(), 0);
  for (std::size_t i = 0; i < groups.size(); ++i)
    for (const std::size_t topic : groups[i].indices) group_of[topic] = i;
  std::vector<const MessagePlace*> first(groups.size(), nullptr), last(groups.size(), nullptr);
  for (const MessagePlace& message : file.messages()) {
    const std::size_t group = group_of.at(message.topic);
    if (!first[group]) first[group] = &message;
    last[group] = &message;
  }
  BagSummary summary{file.kind(), {}, file.warnings()};
  for (std::size_t i = 0; i < groups.size(); ++i) {
    BagTopicSummary topic;
    topic.name = groups[i].name;
    topic.type = groups[i].type;
    topic.messages = groups[i].messages;
    if (first[i]) {
      topic.first = safeTime(first[i]->log_time);
      topic.last = safeTime(last[i]->log_time);
      const MessageEncoding encoding = file.topics()[first[i]->topic].encoding;
      if (encoding != MessageEncoding::Other && hasHeader(topic.type)) {
        try {
          const std::vector<char> bytes = file.read(*first[i]);
          const std::optional<MessageHeader> header =
              headerOf(topic.type, {bytes.data(), bytes.size()}, encoding, originOf(path, file, *first[i]));
          if (header) topic.frame = header->frame;
        } catch (const FileError& error) {
          summary.warnings.emplace_back(error.what());
        }
      }
    }
    summary.topics.push_back(std::move(topic));
  }
  return summary;
}

}  // namespace gaussmap::detail
