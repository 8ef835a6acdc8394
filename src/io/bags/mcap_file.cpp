// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/mcap_file.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/bags/byte_cursor.h"
#include "io/bags/chunk_store.h"
#include "io/bags/mcap_records.h"
#include "io/bags/message_index.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

class McapFile : public MessageFile {
 public:
  McapFile(const std::filesystem::path& path, const std::filesystem::path& shown)
      : store_(path, shown), index_(store_), definitions_(store_, index_) {
    requireStart();
    findSummary();
    readRecords();
    index_.finish(counted_, [this](std::size_t chunk, std::string_view bytes) { definitions_.addChunk(chunk, bytes); });
  }

  std::string kind() const override {
    std::string names;
    for (const Compression compression : compressions_)
      if (compression != Compression::None) names += (names.empty() ? " (" : ", ") + nameOf(compression);
    return "MCAP" + (names.empty() ? "" : names + ")");
  }
  const std::vector<MessageTopic>& topics() const override { return index_.topics(); }
  const std::vector<MessagePlace>& messages() const override { return index_.messages(); }
  std::vector<std::string> warnings() const override { return index_.warnings(); }
  std::vector<char> read(const MessagePlace& message) const override;
  MessageStart readStart(const MessagePlace& message, std::size_t most) const override;

 private:
  using Place = std::uint64_t;
  [[noreturn]] void fail(Place place, const std::string& what) const { store_.fail(0, place, what); }
  void warn(const std::string& warning) { index_.warnings().push_back(warning); }
  void requireStart() const;
  void findSummary();
  void readRecords();
  void readRecord(Place place, const McapRecord& record);
  void readChunkRecord(Place place, std::string_view content);
  void readIndexRecord(std::string_view content);
  void readStatistics(std::string_view content);
  void readDataEnd(Place place, std::string_view content);
  void reportEnd(Place place, const McapRecord& record);

  ChunkStore store_;
  MessageIndex index_;
  McapDefinitions definitions_;
  std::set<Compression> compressions_;
  bool has_end_ = false;  // footer and magic at the end of the file
  bool damaged_summary_ = false;
  bool in_summary_ = false;
  bool messages_outside_ = false;  // of chunks
  std::size_t last_chunk_ = 0;     // the chunk that the next index records describe
  std::int64_t counted_ = -1;
};

void McapFile::requireStart() const {
  const std::string_view bytes = store_.file();
  if (bytes.empty()) throw FileError(store_.path(), "the file is empty");
  if (!isMcap(bytes)) fail(0, "the file starts with " + quote(bytes.substr(0, 8)) + ": it is not an MCAP file");
  McapRecord record;
  if (readMcapRecord(bytes, kMcapMagic.size(), record) && record.kind != mcap::Header)
    fail(kMcapMagic.size(), "expected a Header record (kind 1), found kind " + std::to_string(record.kind));
}

// The file ends with a footer and the magic bytes. The footer has the CRC of the summary and of its own start.
void McapFile::findSummary() {
  constexpr std::size_t kFooter = 20, kEnd = kMcapRecordHead + kFooter + kMcapMagic.size();
  const std::string_view bytes = store_.file();
  if (bytes.size() < kMcapMagic.size() + kEnd) return;
  const std::size_t footer = bytes.size() - kEnd;
  McapRecord record;
  if (bytes.substr(bytes.size() - kMcapMagic.size()) != kMcapMagic) return;
  if (!readMcapRecord(bytes, footer, record) || record.kind != mcap::Footer || record.content.size() != kFooter) return;
  has_end_ = true;
  ByteCursor cursor(record.content);
  const auto summary = cursor.take<std::uint64_t>();
  cursor.take<std::uint64_t>();  // start of the summary offsets
  const auto crc = cursor.take<std::uint32_t>();
  if (crc == 0) return;
  const std::size_t crc_place = footer + kMcapRecordHead + 16;
  const std::size_t start = summary == 0 ? footer : static_cast<std::size_t>(summary);
  damaged_summary_ =
      summary > footer || crc != static_cast<std::uint32_t>(crc32_z(
                                     0, reinterpret_cast<const Bytef*>(bytes.data() + start), crc_place - start));
  if (damaged_summary_) warn("the summary at the end is damaged and is not used");
}

void McapFile::readRecords() {
  const std::string_view bytes = store_.file();
  McapRecord record;
  for (std::size_t place = kMcapMagic.size();; place += kMcapRecordHead + record.content.size()) {
    if (!readMcapRecord(bytes, place, record) || record.kind == 0) return reportEnd(place, record);
    if (in_summary_ && damaged_summary_) return;
    if (record.kind == mcap::Footer) {
      const std::size_t end = place + kMcapRecordHead + record.content.size() + kMcapMagic.size();
      if (end < bytes.size())
        warn("byte " + std::to_string(end) + ": the file ends here, but " + std::to_string(bytes.size() - end) +
             " more bytes follow, which are ignored");
      return;
    }
    readRecord(place, record);
  }
}

void McapFile::reportEnd(Place place, const McapRecord& record) {
  if (!in_summary_) index_.distrust(last_chunk_);  // some of its index records can be missing
  if (in_summary_ || has_end_) {
    warn("byte " + std::to_string(place) + ": the file is damaged, what follows is not used");
    return;
  }
  std::string where = place < store_.file().size() ? " in the middle of a record" : "";
  if (record.kind == mcap::Chunk) where = " in the middle of a chunk";
  if (place < store_.file().size() && record.kind == 0) where = " with bytes that are not a record";
  warn("the recording was not finished: it ends" + where + " at byte " + std::to_string(place) +
       ", and the messages before it are used");
}

void McapFile::readRecord(Place place, const McapRecord& record) {
  switch (record.kind) {
    case mcap::Schema:
      return definitions_.addSchema(record.content, 0, place);
    case mcap::ChannelInfo:
      return definitions_.addChannel(record.content, 0, place);
    case mcap::Message:
      messages_outside_ = true;
      return definitions_.addMessage(record.content, 0, place);
    case mcap::Chunk:
      return readChunkRecord(place, record.content);
    case mcap::MessageIndexes:
      return readIndexRecord(record.content);
    case mcap::Statistics:
      return readStatistics(record.content);
    case mcap::DataEnd:
      return readDataEnd(place, record.content);
    default:
      return;
  }
}

void McapFile::readChunkRecord(Place place, std::string_view content) {
  ByteCursor cursor(content);
  cursor.take<std::uint64_t>();  // first log time
  cursor.take<std::uint64_t>();  // last log time
  Chunk chunk;
  chunk.byte = static_cast<std::size_t>(place);
  chunk.size = cursor.take<std::uint64_t>();
  chunk.crc = cursor.take<std::uint32_t>();
  const std::string_view compression = cursor.takeText();
  chunk.packed = cursor.takeBytes(cursor.take<std::uint64_t>());
  if (!cursor.ok()) fail(place, "the content of the Chunk record is too short for its fields");
  if (compression == "zstd")
    chunk.compression = Compression::Zstd;
  else if (compression == "lz4")
    chunk.compression = Compression::Lz4;
  else if (!compression.empty())
    fail(place, "the chunk is compressed with " + quote(compression) +
                    ", but only zstd and lz4 are read: convert the file with `mcap compress`");
  compressions_.insert(chunk.compression);
  last_chunk_ = store_.add(chunk);
}

// The records after a chunk have the times and places of its messages, one record per channel.
void McapFile::readIndexRecord(std::string_view content) {
  if (last_chunk_ == 0) return;
  ByteCursor cursor(content);
  const auto channel = cursor.take<std::uint16_t>();
  constexpr std::size_t kEntry = 16;
  ByteCursor entries(cursor.takeText());
  bool good = cursor.ok() && entries.rest().size() % kEntry == 0;
  if (good) index_.markIndexed(last_chunk_);
  while (good && !entries.empty()) {
    const auto time = entries.take<std::uint64_t>();
    const auto offset = entries.take<std::uint64_t>();
    good = offset < store_.chunk(last_chunk_).size;
    if (good) index_.add(channel, logTime(time), last_chunk_, offset);
  }
  if (good) return;
  index_.distrust(last_chunk_);
  last_chunk_ = 0;
}

void McapFile::readStatistics(std::string_view content) {
  ByteCursor cursor(content);
  const auto messages = cursor.take<std::uint64_t>();
  if (cursor.ok() && messages < (std::uint64_t{1} << 62)) counted_ = static_cast<std::int64_t>(messages);
}

void McapFile::readDataEnd(Place place, std::string_view content) {
  in_summary_ = true;
  last_chunk_ = 0;
  ByteCursor cursor(content);
  const auto crc = cursor.take<std::uint32_t>();
  // Chunks have their own CRC. Messages outside of chunks have only this one.
  if (crc == 0 || !messages_outside_) return;
  const auto* const bytes = reinterpret_cast<const Bytef*>(store_.file().data());
  if (crc != static_cast<std::uint32_t>(crc32_z(0, bytes, static_cast<std::size_t>(place))))
    warn("the file is damaged somewhere: the CRC of its messages is wrong");
}

std::vector<char> McapFile::read(const MessagePlace& message) const {
  const std::size_t chunk = MessageIndex::chunkOf(message);
  const std::uint64_t offset = MessageIndex::offsetOf(message);
  const ChunkBytes bytes = store_.bytes(chunk);
  McapRecord record;
  McapMessage found;
  if (!readMcapRecord(bytes.bytes, offset, record) || record.kind != mcap::Message ||
      !readMcapMessage(record.content, found))
    store_.fail(chunk, offset, "expected a Message record: the file or its index is damaged");
  index_.requireSame(message, found.channel, found.log_time);
  if (index_.topics()[message.topic].encoding == MessageEncoding::Cdr && isZstd(found.data)) {
    std::vector<char> expanded;
    const std::string error = expandMessage(found.data, expanded);
    if (!error.empty()) store_.fail(chunk, offset, "the compressed message " + error);
    return expanded;
  }
  std::vector<char> data(found.data.begin(), found.data.end());
  store_.finishedWith(found.data);
  return data;
}

MessageStart McapFile::readStart(const MessagePlace& message, std::size_t most) const {
  constexpr std::size_t kHeads = kMcapRecordHead + kMcapMessageHead;
  const std::size_t chunk = MessageIndex::chunkOf(message);
  const std::uint64_t offset = MessageIndex::offsetOf(message);
  const ChunkBytes bytes = store_.start(chunk, offset + kHeads + std::max(most, kZstdMagicBytes));
  McapRecord record;
  McapMessage found;
  readMcapRecord(bytes.bytes, offset, record);  // false if the record is longer than the start
  const bool is_message = record.kind == mcap::Message && readMcapMessage(record.content, found) &&
                          record.size <= store_.size(chunk) - offset - kMcapRecordHead;
  if (!is_message || isZstd(found.data)) return MessageFile::readStart(message, most);
  index_.requireSame(message, found.channel, found.log_time);
  const std::string_view data = found.data.substr(0, most);
  MessageStart start{{data.begin(), data.end()}, static_cast<std::size_t>(record.size) - kMcapMessageHead};
  store_.finishedWith(data);
  return start;
}

}  // namespace

bool isMcap(std::string_view start) {
  return start.substr(0, kMcapMagic.size()) == kMcapMagic;
}

std::unique_ptr<MessageFile> openMcap(const std::filesystem::path& path, const std::filesystem::path& shown) {
  return std::make_unique<McapFile>(path, shown);
}

}  // namespace gaussmap::detail
