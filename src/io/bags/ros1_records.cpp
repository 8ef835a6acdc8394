// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/ros1_records.h"

#include <utility>

#include "io/bags/byte_cursor.h"

namespace gaussmap::detail {

bool readRos1Record(std::string_view bytes, std::uint64_t place, Ros1Record& record) {
  record = {};
  if (place > bytes.size()) return false;
  ByteCursor cursor(bytes.substr(static_cast<std::size_t>(place)));
  record.header = cursor.takeText();
  if (!cursor.ok()) return false;
  findRos1Number(record.header, "op", record.kind);
  const auto size = cursor.take<std::uint32_t>();
  if (!cursor.ok()) return false;
  record.size = size;
  record.data = cursor.rest().substr(0, size);
  record.bytes = 2 * sizeof(std::uint32_t) + record.header.size() + record.data.size();
  return record.data.size() == size;
}

bool findRos1Field(std::string_view fields, std::string_view name, std::string_view& value) {
  ByteCursor cursor(fields);
  while (!cursor.empty()) {
    const std::string_view field = cursor.takeText();
    if (!cursor.ok()) return false;
    if (field.size() > name.size() && field[name.size()] == '=' && field.substr(0, name.size()) == name) {
      value = field.substr(name.size() + 1);
      return true;
    }
  }
  return false;
}

std::chrono::nanoseconds ros1Time(std::uint64_t time) {
  const auto seconds = static_cast<std::int64_t>(time & 0xFFFFFFFFu),
             nanoseconds = static_cast<std::int64_t>(time >> 32);
  return std::chrono::seconds(seconds) + std::chrono::nanoseconds(nanoseconds);
}

bool readRos1Message(const Ros1Record& record, Ros1Message& message) {
  std::uint64_t time = 0;
  if (!findRos1Number(record.header, "conn", message.connection) || !findRos1Number(record.header, "time", time))
    return false;
  message.time = ros1Time(time);
  return true;
}

void addRos1Connection(const ChunkStore& store, MessageIndex& index, const Ros1Record& record, std::size_t chunk,
                       std::uint64_t offset) {
  std::uint32_t number = 0;
  std::string_view topic, type;
  if (!findRos1Number(record.header, "conn", number) || !findRos1Field(record.header, "topic", topic))
    store.fail(chunk, offset, "the header of the connection has no fields conn and topic");
  if (!findRos1Field(record.data, "type", type))
    store.fail(chunk, offset, "connection " + std::to_string(number) + " has no field type");
  index.define(number, {std::string(topic), typeName(type), MessageEncoding::Ros1}, chunk, offset);
}

void addRos1Message(const ChunkStore& store, MessageIndex& index, const Ros1Record& record, std::size_t chunk,
                    std::uint64_t offset) {
  Ros1Message message;
  if (!readRos1Message(record, message))
    store.fail(chunk, offset, "the header of the message has no fields conn and time");
  index.add(message.connection, message.time, chunk, offset);
}

void addRos1Chunk(const ChunkStore& store, MessageIndex& index, std::size_t chunk, std::string_view bytes) {
  Ros1Record record;
  for (std::size_t place = 0; place < bytes.size(); place += record.bytes) {
    if (!readRos1Record(bytes, place, record)) store.fail(chunk, place, "a record reaches beyond the end of the chunk");
    if (record.kind == ros1::Connection)
      addRos1Connection(store, index, record, chunk, place);
    else if (record.kind == ros1::MessageData)
      addRos1Message(store, index, record, chunk, place);
    else
      store.fail(chunk, place,
                 "expected a message (op 2) or a connection (op 7), found op " + std::to_string(record.kind));
  }
}

}  // namespace gaussmap::detail
