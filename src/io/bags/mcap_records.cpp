// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/mcap_records.h"

#include <algorithm>
#include <utility>

#include "io/bags/byte_cursor.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

// The index refuses names that are longer than 1000 characters.
constexpr std::size_t kLongestSchemaName = 1001;

}  // namespace

bool readMcapRecord(std::string_view bytes, std::uint64_t place, McapRecord& record) {
  record = {};
  if (place > bytes.size()) return false;
  ByteCursor cursor(bytes.substr(static_cast<std::size_t>(place)));
  record.kind = cursor.take<std::uint8_t>();
  record.size = cursor.take<std::uint64_t>();
  if (!cursor.ok()) return false;
  record.content =
      cursor.rest().substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(record.size, bytes.size())));
  return record.content.size() == record.size;
}

bool readMcapMessage(std::string_view content, McapMessage& message) {
  ByteCursor cursor(content);
  message.channel = cursor.take<std::uint16_t>();
  cursor.take<std::uint32_t>();  // sequence number
  message.log_time = logTime(cursor.take<std::uint64_t>());
  cursor.take<std::uint64_t>();  // publish time
  message.data = cursor.rest();
  return cursor.ok();
}

void McapDefinitions::failShort(const char* record, std::size_t chunk, std::uint64_t offset) const {
  store_.fail(chunk, offset, std::string("the content of the ") + record + " record is too short for its fields");
}

void McapDefinitions::addSchema(std::string_view content, std::size_t chunk, std::uint64_t offset) {
  ByteCursor cursor(content);
  const auto number = cursor.take<std::uint16_t>();
  const std::string_view name = cursor.takeText().substr(0, kLongestSchemaName);
  if (!cursor.ok()) failShort("Schema", chunk, offset);
  if (number == 0) store_.fail(chunk, offset, "a schema has the number 0, which means no schema");
  const auto [place, added] = schemas_.emplace(number, name);
  if (!added && place->second != name)
    store_.fail(chunk, offset,
                "schema " + std::to_string(number) + " is " + quote(place->second) + " and also " + quote(name) +
                    ": the file is damaged, or two files were joined");
}

void McapDefinitions::addChannel(std::string_view content, std::size_t chunk, std::uint64_t offset) {
  ByteCursor cursor(content);
  const auto number = cursor.take<std::uint16_t>();
  const auto schema = cursor.take<std::uint16_t>();
  Channel channel;
  channel.topic = cursor.takeText();
  const std::string_view encoding = cursor.takeText();
  if (!cursor.ok()) failShort("Channel", chunk, offset);
  if (encoding == "cdr") channel.encoding = MessageEncoding::Cdr;
  if (encoding == "ros1") channel.encoding = MessageEncoding::Ros1;
  if (schema != 0) {
    const auto found = schemas_.find(schema);
    if (found == schemas_.end())
      store_.fail(chunk, offset,
                  "channel " + std::to_string(number) + " has schema " + std::to_string(schema) +
                      ", which is not defined before it");
    channel.type = typeName(found->second);
  }
  index_.define(number, std::move(channel), chunk, offset);
}

void McapDefinitions::addMessage(std::string_view content, std::size_t chunk, std::uint64_t offset) {
  McapMessage message;
  if (!readMcapMessage(content, message)) failShort("Message", chunk, offset);
  index_.add(message.channel, message.log_time, chunk, offset);
}

void McapDefinitions::addChunk(std::size_t chunk, std::string_view bytes) {
  McapRecord record;
  for (std::size_t place = 0; place < bytes.size(); place += kMcapRecordHead + record.content.size()) {
    if (!readMcapRecord(bytes, place, record))
      store_.fail(chunk, place, "a record reaches beyond the end of the chunk");
    switch (record.kind) {
      case mcap::Schema:
        addSchema(record.content, chunk, place);
        break;
      case mcap::ChannelInfo:
        addChannel(record.content, chunk, place);
        break;
      case mcap::Message:
        addMessage(record.content, chunk, place);
        break;
      case 0:
        store_.fail(chunk, place, "a record has the kind 0, which does not exist");
      default:
        break;
    }
  }
}

}  // namespace gaussmap::detail
