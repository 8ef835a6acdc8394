// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/ros1_bag.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/bags/byte_cursor.h"
#include "io/bags/chunk_store.h"
#include "io/bags/message_index.h"
#include "io/bags/ros1_records.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V";
constexpr std::string_view kBagVersion = "#ROSBAG V2.0\n";
constexpr std::uint64_t kMaxCounted = std::uint64_t{1} << 62;

class Ros1Bag : public MessageFile {
 public:
  Ros1Bag(const std::filesystem::path& path, const std::filesystem::path& shown) : store_(path, shown), index_(store_) {
    requireVersion();
    readRecords();
    index_.finish(counted_,
                  [this](std::size_t chunk, std::string_view bytes) { addRos1Chunk(store_, index_, chunk, bytes); });
  }

  std::string kind() const override {
    std::string names;
    for (const Compression compression : compressions_)
      if (compression != Compression::None) names += (names.empty() ? " (" : ", ") + nameOf(compression);
    return "ROS 1 bag" + (names.empty() ? "" : names + ")");
  }
  const std::vector<MessageTopic>& topics() const override { return index_.topics(); }
  const std::vector<MessagePlace>& messages() const override { return index_.messages(); }
  std::vector<std::string> warnings() const override { return index_.warnings(); }
  std::vector<char> read(const MessagePlace& message) const override;
  MessageStart readStart(const MessagePlace& message, std::size_t most) const override;

 private:
  [[noreturn]] void fail(std::size_t place, const std::string& what) const { store_.fail(0, place, what); }
  void warn(const std::string& warning) { index_.warnings().push_back(warning); }
  void requireVersion() const;
  void readRecords();
  void readRecord(std::size_t place, const Ros1Record& record);
  void readBagHeader(std::size_t place, const Ros1Record& record);
  void readChunkRecord(std::size_t place, const Ros1Record& record);
  void readIndexData(const Ros1Record& record);
  void countChunkInfo(const Ros1Record& record);
  void reportEnd(std::size_t place, const Ros1Record& record);

  ChunkStore store_;
  MessageIndex index_;
  std::set<Compression> compressions_;
  std::uint64_t index_place_ = 0;  // of the connections and chunk infos at the end; 0: not finished
  std::uint32_t chunk_count_ = 0;
  std::size_t last_chunk_ = 0;  // the chunk that the next index records describe
  std::size_t infos_ = 0;
  std::size_t empty_chunks_ = 0;
  std::uint64_t info_messages_ = 0;
  std::uint64_t messages_outside_ = 0;  // of chunks
  std::int64_t counted_ = -1;
};

void Ros1Bag::requireVersion() const {
  const std::string_view bytes = store_.file();
  if (bytes.empty()) throw FileError(store_.path(), "the file is empty");
  if (bytes.substr(0, kBagVersion.size()) == kBagVersion) return;
  if (isRos1Bag(bytes))
    fail(0, "the bag starts with " + quote(bytes.substr(0, kBagVersion.size() - 1)) +
                ", but only version 2.0 is read: convert it with `rosbag fix` of ROS 1");
  fail(0, "the file starts with " + quote(bytes.substr(0, kBagVersion.size())) + ": it is not a bag of ROS 1");
}

void Ros1Bag::readRecords() {
  const std::string_view bytes = store_.file();
  Ros1Record record;
  std::size_t place = kBagVersion.size();
  for (; place < bytes.size(); place += record.bytes) {
    if (!readRos1Record(bytes, place, record) || record.kind == 0) break;
    readRecord(place, record);
  }
  if (place < bytes.size() || index_place_ == 0) return reportEnd(place, record);
  if (infos_ != chunk_count_ || store_.chunks() + empty_chunks_ != chunk_count_)
    warn("the bag announces " + std::to_string(chunk_count_) + " chunks, but it has " +
         std::to_string(store_.chunks() + empty_chunks_) + " and describes " + std::to_string(infos_));
  else if (info_messages_ < kMaxCounted)
    counted_ = static_cast<std::int64_t>(info_messages_ + messages_outside_);
}

void Ros1Bag::reportEnd(std::size_t place, const Ros1Record& record) {
  index_.distrust(last_chunk_);  // some of its index records can be missing
  if (index_place_ != 0 && place >= index_place_) {
    warn("byte " + std::to_string(place) + ": the index at the end is damaged");
    return;
  }
  std::string where;
  if (place < store_.file().size())
    where = record.kind == ros1::Chunk ? ": it ends in the middle of a chunk at byte " + std::to_string(place)
                                       : ": it ends in the middle of a record at byte " + std::to_string(place);
  warn(index_place_ == 0
           ? "the recording was not finished, the bag has no index" + where + "; the messages before the end are used"
           : "the bag was cut off" + where + "; the messages before it are used");
}

void Ros1Bag::readRecord(std::size_t place, const Ros1Record& record) {
  if (place == kBagVersion.size()) return readBagHeader(place, record);
  switch (record.kind) {
    case ros1::MessageData:
      ++messages_outside_;
      return addRos1Message(store_, index_, record, 0, place);
    case ros1::IndexData:
      return readIndexData(record);
    case ros1::Chunk:
      return readChunkRecord(place, record);
    case ros1::ChunkInfo:
      return countChunkInfo(record);
    case ros1::Connection:
      return addRos1Connection(store_, index_, record, 0, place);
    default:
      return;
  }
}

void Ros1Bag::readBagHeader(std::size_t place, const Ros1Record& record) {
  if (record.kind != ros1::BagHeader)
    fail(place, "expected the header of the bag (op 3), found op " + std::to_string(record.kind));
  std::string_view encryptor;
  if (findRos1Field(record.header, "encryptor", encryptor) && !encryptor.empty())
    fail(place, "the bag is encrypted with " + quote(encryptor) + ": decrypt it with `rosbag decrypt` of ROS 1");
  if (!findRos1Number(record.header, "index_pos", index_place_) ||
      !findRos1Number(record.header, "chunk_count", chunk_count_))
    fail(place, "the header of the bag has no fields index_pos and chunk_count");
}

void Ros1Bag::readChunkRecord(std::size_t place, const Ros1Record& record) {
  Chunk chunk;
  chunk.byte = place;
  chunk.packed = record.data;
  std::uint32_t size = 0;
  std::string_view compression;
  if (!findRos1Number(record.header, "size", size) || !findRos1Field(record.header, "compression", compression))
    fail(place, "the header of the chunk has no fields size and compression");
  chunk.size = size;
  if (compression == "bz2")
    chunk.compression = Compression::Bz2;
  else if (compression == "lz4")
    chunk.compression = Compression::Lz4;
  else if (compression != "none")
    fail(place, "the chunk is compressed with " + quote(compression) +
                    ", but only none, bz2 and lz4 are known: decompress it with `rosbag decompress` of ROS 1");
  compressions_.insert(chunk.compression);
  // The last chunk of an unfinished bag has no size yet. Without compression its records follow as records of the file.
  last_chunk_ = size == 0 && chunk.packed.empty() ? 0 : store_.add(chunk);
  empty_chunks_ += last_chunk_ == 0;
}

// The records after a chunk have the times and places of its messages, one record per connection.
void Ros1Bag::readIndexData(const Ros1Record& record) {
  if (last_chunk_ == 0) return;
  std::uint32_t version = 0, connection = 0, count = 0;
  constexpr std::size_t kEntry = 12;
  bool good = findRos1Number(record.header, "ver", version) && version == 1 &&
              findRos1Number(record.header, "conn", connection) && findRos1Number(record.header, "count", count) &&
              record.data.size() == count * kEntry;
  if (good) index_.markIndexed(last_chunk_);
  ByteCursor entries(record.data);
  while (good && !entries.empty()) {
    const auto time = entries.take<std::uint64_t>();
    const auto offset = entries.take<std::uint32_t>();
    good = offset < store_.chunk(last_chunk_).size;
    if (good) index_.add(connection, ros1Time(time), last_chunk_, offset);
  }
  if (good) return;
  index_.distrust(last_chunk_);
  last_chunk_ = 0;
}

void Ros1Bag::countChunkInfo(const Ros1Record& record) {
  ++infos_;
  ByteCursor counts(record.data);
  while (!counts.empty()) {
    counts.take<std::uint32_t>();  // connection
    info_messages_ += counts.take<std::uint32_t>();
  }
}

std::vector<char> Ros1Bag::read(const MessagePlace& message) const {
  const std::size_t chunk = MessageIndex::chunkOf(message);
  const std::uint64_t offset = MessageIndex::offsetOf(message);
  const ChunkBytes bytes = store_.bytes(chunk);
  Ros1Record record;
  Ros1Message found;
  if (!readRos1Record(bytes.bytes, offset, record) || record.kind != ros1::MessageData ||
      !readRos1Message(record, found))
    store_.fail(chunk, offset, "expected a message (op 2): the bag or its index is damaged");
  index_.requireSame(message, found.connection, found.time);
  std::vector<char> data(record.data.begin(), record.data.end());
  store_.finishedWith(record.data);
  return data;
}

MessageStart Ros1Bag::readStart(const MessagePlace& message, std::size_t most) const {
  constexpr std::size_t kUsualHeads = 64;  // lengths and header of a message
  const std::size_t chunk = MessageIndex::chunkOf(message);
  const std::uint64_t offset = MessageIndex::offsetOf(message);
  const ChunkBytes bytes = store_.start(chunk, offset + kUsualHeads + most);
  Ros1Record record;
  Ros1Message found;
  readRos1Record(bytes.bytes, offset, record);  // false if the record is longer than the start
  const bool is_message = record.kind == ros1::MessageData && readRos1Message(record, found) && record.bytes > 0 &&
                          record.size - record.data.size() <= store_.size(chunk) - offset - record.bytes;
  if (!is_message || record.data.size() < std::min<std::uint64_t>(record.size, most))
    return MessageFile::readStart(message, most);
  index_.requireSame(message, found.connection, found.time);
  const std::string_view data = record.data.substr(0, most);
  MessageStart start{{data.begin(), data.end()}, static_cast<std::size_t>(record.size)};
  store_.finishedWith(data);
  return start;
}

}  // namespace

bool isRos1Bag(std::string_view start) {
  return start.substr(0, kBagMagic.size()) == kBagMagic;
}

std::unique_ptr<MessageFile> openRos1Bag(const std::filesystem::path& path, const std::filesystem::path& shown) {
  return std::make_unique<Ros1Bag>(path, shown);
}

}  // namespace gaussmap::detail
