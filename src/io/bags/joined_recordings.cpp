// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "io/bags/recording.h"

namespace gaussmap::detail {
namespace {

class JoinedRecordings : public MessageFile {
 public:
  JoinedRecordings(std::vector<std::unique_ptr<MessageFile>> files, const std::vector<std::string>& names,
                   std::vector<std::string> warnings)
      : files_(std::move(files)), warnings_(std::move(warnings)) {
    std::uint64_t begin = 0;
    for (std::size_t file = 0; file < files_.size(); ++file) {
      begins_.push_back(begin);
      addTopics(*files_[file], begin);
      begin += files_[file]->messages().size();
      for (const std::string& warning : files_[file]->warnings()) warnings_.push_back(names[file] + ": " + warning);
    }
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const MessagePlace& a, const MessagePlace& b) { return a.log_time < b.log_time; });
  }

  std::string kind() const override {
    std::set<std::string> kinds;
    for (const auto& file : files_) kinds.insert(file->kind());
    std::string text;
    for (const std::string& kind : kinds) text += (text.empty() ? "" : ", ") + kind;
    return files_.size() == 1 ? text : std::to_string(files_.size()) + " files: " + text;
  }
  const std::vector<MessageTopic>& topics() const override { return topics_; }
  const std::vector<MessagePlace>& messages() const override { return messages_; }
  std::vector<std::string> warnings() const override { return warnings_; }

  std::vector<char> read(const MessagePlace& message) const override {
    const std::size_t file = fileOf(message);
    return files_[file]->read(placeIn(file, message));
  }
  MessageStart readStart(const MessagePlace& message, std::size_t most) const override {
    const std::size_t file = fileOf(message);
    return files_[file]->readStart(placeIn(file, message), most);
  }

 private:
  std::size_t fileOf(const MessagePlace& message) const {
    const auto next = std::upper_bound(begins_.begin(), begins_.end(), message.place);
    return static_cast<std::size_t>(next - begins_.begin() - 1);
  }
  const MessagePlace& placeIn(std::size_t file, const MessagePlace& message) const {
    return files_[file]->messages().at(static_cast<std::size_t>(message.place - begins_[file]));
  }

  void addTopics(const MessageFile& file, std::uint64_t begin) {
    std::vector<std::size_t> numbers;
    for (const MessageTopic& topic : file.topics()) {
      const auto [place, added] =
          topic_numbers_.emplace(std::make_tuple(topic.name, topic.type, topic.encoding), topics_.size());
      if (added)
        topics_.push_back(topic);
      else
        topics_[place->second].messages += topic.messages;
      numbers.push_back(place->second);
    }
    for (std::size_t i = 0; i < file.messages().size(); ++i) {
      const MessagePlace& message = file.messages()[i];
      messages_.push_back({numbers[message.topic], message.log_time, begin + i});
    }
  }

  std::vector<std::unique_ptr<MessageFile>> files_;
  std::vector<std::uint64_t> begins_;  // for each file: the messages before it
  std::map<std::tuple<std::string, std::string, MessageEncoding>, std::size_t> topic_numbers_;
  std::vector<MessageTopic> topics_;
  std::vector<MessagePlace> messages_;  // place: number of the message in all files
  std::vector<std::string> warnings_;
};

}  // namespace

std::unique_ptr<MessageFile> joinRecordings(std::vector<std::unique_ptr<MessageFile>> files,
                                            const std::vector<std::string>& names, std::vector<std::string> warnings) {
  return std::make_unique<JoinedRecordings>(std::move(files), names, std::move(warnings));
}

}  // namespace gaussmap::detail
