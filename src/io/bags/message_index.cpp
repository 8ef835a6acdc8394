// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/message_index.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "gaussmap/core/error.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kMaxChannels = 65536;  // MCAP cannot have more
constexpr std::size_t kLongestName = 1000;   // names of topics and types

}  // namespace

std::string typeName(std::string_view type) {
  std::string name(type);
  const std::size_t middle = name.find("/msg/");
  if (middle != std::string::npos) name.erase(middle, 4);
  return name;
}

std::chrono::nanoseconds logTime(std::uint64_t nanoseconds) {
  constexpr auto kLast = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return std::chrono::nanoseconds(static_cast<std::int64_t>(std::min(nanoseconds, kLast)));
}

void MessageIndex::define(std::uint32_t number, Channel channel, std::size_t chunk, std::uint64_t offset) {
  const auto found = channels_.find(number);
  if (found == channels_.end()) {
    if (channel.topic.size() > kLongestName || channel.type.size() > kLongestName)
      store_->fail(chunk, offset, "the name of a topic or of its type is longer than 1000 characters");
    if (channels_.size() >= kMaxChannels) store_->fail(chunk, offset, "the file has more than 65536 channels");
    channels_.emplace(number, std::move(channel));
    return;
  }
  const Channel& first = found->second;
  if (std::tie(first.topic, first.type, first.encoding) == std::tie(channel.topic, channel.type, channel.encoding))
    return;
  store_->fail(chunk, offset,
               "channel " + std::to_string(number) + " is " + quote(first.topic) + " (" + quote(first.type) +
                   ") and also " + quote(channel.topic) + " (" + quote(channel.type) +
                   "): the file is damaged, or two files were joined");
}

void MessageIndex::add(std::uint32_t channel, std::chrono::nanoseconds time, std::size_t chunk, std::uint64_t offset) {
  const std::size_t most = 1000000 + store_->file().size();
  if (messages_.size() >= most)
    store_->fail(chunk, offset,
                 "the file of " + std::to_string(store_->file().size()) + " bytes has more than " +
                     std::to_string(most) + " messages: it is damaged, or made to fill the memory");
  if (chunk >= (std::size_t{1} << (64 - kOffsetBits)) || offset >= (std::uint64_t{1} << kOffsetBits))
    store_->fail(chunk, offset, "the file has more than 16777215 chunks, or is larger than 1 TiB");
  messages_.push_back({channel, time, std::uint64_t{chunk} << kOffsetBits | offset});
}

void MessageIndex::markIndexed(std::size_t chunk) {
  if (indexed_.size() <= chunk) indexed_.resize(chunk + 1, false);
  indexed_[chunk] = true;
}

void MessageIndex::distrust(std::size_t chunk) {
  if (chunk < indexed_.size()) indexed_[chunk] = false;
}

void MessageIndex::sortByPlace() {
  const auto before = [](const MessagePlace& a, const MessagePlace& b) { return a.place < b.place; };
  if (!std::is_sorted(messages_.begin(), messages_.end(), before))
    std::stable_sort(messages_.begin(), messages_.end(), before);
  messages_.erase(std::unique(messages_.begin(), messages_.end(),
                              [](const MessagePlace& a, const MessagePlace& b) { return a.place == b.place; }),
                  messages_.end());
}

void MessageIndex::readChunk(std::size_t chunk, const ReadChunk& read_chunk) {
  read_[chunk] = true;
  try {
    const ChunkBytes bytes = store_->bytes(chunk);
    read_chunk(chunk, bytes.bytes);
    store_->finishedWith(bytes.bytes);
  } catch (const FileError& error) {
    const std::string what = error.what(), path = store_->path().string() + ": ";
    if (damaged_chunks_++ == 0) first_damage_ = what.rfind(path, 0) == 0 ? what.substr(path.size()) : what;
  }
}

void MessageIndex::readChunks(const ReadChunk& read_chunk) {
  const std::size_t known = messages_.size();
  const std::vector<bool> before = read_;
  // A channel that no summary defines is defined in the first chunk that uses it, or before.
  std::size_t next = 1;  // the chunks before it have been read
  for (std::size_t i = 0; i < known; ++i) {
    if (channels_.count(static_cast<std::uint32_t>(messages_[i].topic)) > 0) continue;
    for (; next <= chunkOf(messages_[i]); ++next)
      if (!read_[next]) readChunk(next, read_chunk);
  }
  for (std::size_t chunk = 1; chunk < indexed_.size(); ++chunk)
    if (!indexed_[chunk] && !read_[chunk]) readChunk(chunk, read_chunk);
  const auto end_of_known = messages_.begin() + static_cast<std::ptrdiff_t>(known);
  messages_.erase(
      std::remove_if(messages_.begin(), end_of_known,
                     [&](const MessagePlace& message) { return read_[chunkOf(message)] && !before[chunkOf(message)]; }),
      end_of_known);
  sortByPlace();
}

void MessageIndex::compareCount(std::uint64_t counted, const ReadChunk& read_chunk) {
  if (counted == messages_.size()) return;
  const std::size_t before = messages_.size();
  std::fill(indexed_.begin(), indexed_.end(), false);
  readChunks(read_chunk);
  if (messages_.size() != before)
    warnings_.push_back("the index has " + std::to_string(before) + " messages, but the chunks have " +
                        std::to_string(messages_.size()) + ": the chunks were read instead");
  if (counted != messages_.size())
    warnings_.push_back("the summary counts " + std::to_string(counted) + " messages, but " +
                        std::to_string(messages_.size()) + " were found");
}

void MessageIndex::reportDamage() {
  if (damaged_chunks_ == 0) return;
  if (messages_.empty() && damaged_chunks_ == store_->chunks()) throw FileError(store_->path(), first_damage_);
  warnings_.push_back("messages are missing because " + std::to_string(damaged_chunks_) +
                      (damaged_chunks_ == 1 ? " chunk is" : " chunks are") +
                      " damaged, the first one: " + first_damage_);
}

void MessageIndex::finish(std::int64_t counted, const ReadChunk& read_chunk) {
  indexed_.resize(store_->chunks() + 1, false);
  read_.resize(store_->chunks() + 1, false);
  readChunks(read_chunk);
  if (counted >= 0) compareCount(static_cast<std::uint64_t>(counted), read_chunk);
  reportDamage();
  makeTopics();
}

void MessageIndex::makeTopics() {
  std::map<std::tuple<std::string, std::string, MessageEncoding>, std::size_t> numbers;
  for (const auto& [number, channel] : channels_) {
    const auto [place, added] =
        numbers.emplace(std::make_tuple(channel.topic, channel.type, channel.encoding), topics_.size());
    if (added) topics_.push_back({channel.topic, channel.type, channel.encoding, 0});
    topic_of_channel_[number] = place->second;
  }
  std::size_t kept = 0, unknown = 0;
  for (MessagePlace& message : messages_) {
    const auto topic = topic_of_channel_.find(static_cast<std::uint32_t>(message.topic));
    if (topic == topic_of_channel_.end()) {
      ++unknown;
      continue;
    }
    message.topic = topic->second;
    ++topics_[message.topic].messages;
    messages_[kept++] = message;
  }
  messages_.resize(kept);
  messages_.shrink_to_fit();
  if (unknown > 0)
    warnings_.push_back(std::to_string(unknown) + " messages are ignored, because their channel is not defined");
  const auto earlier = [](const MessagePlace& a, const MessagePlace& b) { return a.log_time < b.log_time; };
  if (!std::is_sorted(messages_.begin(), messages_.end(), earlier))
    std::stable_sort(messages_.begin(), messages_.end(), earlier);
}

void MessageIndex::requireSame(const MessagePlace& expected, std::uint32_t channel,
                               std::chrono::nanoseconds time) const {
  const auto topic = topic_of_channel_.find(channel);
  if (topic == topic_of_channel_.end() || topic->second != expected.topic || time != expected.log_time)
    store_->fail(chunkOf(expected), offsetOf(expected),
                 "another message than the index of the file says: the file is damaged");
}

}  // namespace gaussmap::detail
