// SPDX-License-Identifier: BSD-3-Clause
#include "commands/topic_table.h"

#include <algorithm>
#include <chrono>

#include "common/report.h"
#include "io/formats/message_file.h"
#include "io/messages/bag_topics.h"

namespace gaussmap::app {
using namespace detail;

namespace {

double seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

std::string rateOf(const BagTopicSummary& topic) {
  const double duration = topic.first ? seconds(*topic.last - *topic.first) : 0.0;
  return duration > 0.0 ? formatted("%.4g Hz", static_cast<double>(topic.messages - 1) / duration) : "-";
}

std::string timesOf(const BagTopicSummary& topic) {
  if (!topic.first) return "-";
  return stampText(*topic.first).substr(0, stampText(*topic.first).size() - 3) + " + " +
         formatted("%.3f s", seconds(*topic.last - *topic.first));
}

Json jsonOf(const BagTopicSummary& topic) {
  Json json = {{"topic", topic.name}, {"type", topic.type}, {"messages", topic.messages}, {"frame", topic.frame}};
  if (topic.first) json["times"] = {seconds(*topic.first), seconds(*topic.last)};
  return json;
}

}  // namespace

TopicTable topicsOf(const std::filesystem::path& recording) {
  const BagSummary summary = bagSummary(*openMessageFile(recording), recording);
  TopicTable table;
  table.json = {
      {"file", recording.string()}, {"kind", summary.kind}, {"topics", Json::array()}, {"warnings", summary.warnings}};
  std::size_t name_width = 5, type_width = 4;
  for (const BagTopicSummary& topic : summary.topics) {
    name_width = std::max(name_width, topic.name.size());
    type_width = std::max(type_width, topic.type.size());
  }
  const auto padded = [](std::string text, std::size_t width) {
    text.resize(std::max(text.size(), width), ' ');
    return text;
  };
  const auto row = [&](const std::string& name, const std::string& type, const std::string& messages,
                       const std::string& rate, const std::string& times, const std::string& frame) {
    table.text += "  " + padded(name, name_width) + "  " + padded(type, type_width) + "  " + padded(messages, 8) +
                  "  " + padded(rate, 9) + "  " + padded(times, 31) + "  " + frame + "\n";
  };
  table.text = recording.string() + ": " + summary.kind + "\n";
  row("topic", "type", "messages", "rate", "first message [s] + duration", "frame");
  for (const BagTopicSummary& topic : summary.topics) {
    row(shown(topic.name), shown(topic.type), std::to_string(topic.messages), rateOf(topic), timesOf(topic),
        topic.frame.empty() ? "-" : shown(topic.frame));
    table.json["topics"].push_back(jsonOf(topic));
  }
  return table;
}

}  // namespace gaussmap::app
