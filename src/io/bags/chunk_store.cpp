// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/chunk_store.h"

#include <zlib.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "gaussmap/core/error.h"

namespace gaussmap::detail {
namespace {

constexpr std::uint64_t kMostKeptBytes = std::uint64_t{512} << 20;
constexpr std::size_t kReturns = 8;  // per kept chunk
constexpr std::size_t kMostFinishedBytes = std::size_t{8} << 20;
constexpr std::size_t kReadAhead = std::size_t{64} << 10;  // the kernel maps so much around a byte that is read

std::uint32_t crcOf(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

ChunkStore::ChunkStore(const std::filesystem::path& path, std::filesystem::path shown)
    : shown_(std::move(shown)), file_(path), chunks_(1) {
  chunks_[0].packed = file_.bytes();
}

std::size_t ChunkStore::add(const Chunk& chunk) {
  const auto refuse = [&](const std::string& what) {
    throw FileError(shown_, "byte " + std::to_string(chunk.byte) + ": the chunk of " +
                                std::to_string(chunk.packed.size()) + " bytes (" + nameOf(chunk.compression) +
                                ") claims to expand to " + std::to_string(chunk.size) + " bytes: " + what);
  };
  if (chunk.compression == Compression::None) {
    if (chunk.size != chunk.packed.size()) refuse("without compression both must be equal");
  } else {
    if (chunk.size > maxExpanded(chunk.packed.size())) refuse("the file is damaged, or made to fill the memory");
    constexpr std::uint64_t kAlways = kMostKeptBytes, kTimes = 200;
    total_ += chunk.size;  // cannot overflow, because each chunk is limited
    if (total_ > kAlways + kTimes * file().size())
      refuse("all chunks together have more than 512 MiB plus 200 times the size of the file");
  }
  chunks_.push_back(chunk);
  finishedWith(chunk.packed.substr(0, 1));  // its record was read
  return chunks_.size() - 1;
}

ChunkBytes ChunkStore::bytes(std::size_t number) const {
  const Chunk& chunk = chunks_.at(number);
  const bool packed = chunk.compression != Compression::None;
  if (!packed && chunk.crc == 0) {
    file_.requireWhole();
    return {chunk.packed, nullptr};
  }
  const std::shared_ptr<Slot> slot = slotOf(number);
  const std::lock_guard<std::mutex> lock(slot->filling);
  if (packed && !slot->bytes) {
    slot->start = nullptr;  // first, because both together need more memory
    slot->start_size = 0;
    slot->bytes = expanded(chunk);
  }
  const std::string_view bytes =
      packed ? std::string_view(slot->bytes.get(), static_cast<std::size_t>(chunk.size)) : chunk.packed;
  if (!slot->checked) check(chunk, bytes);
  slot->checked = true;
  return {bytes, slot->bytes};
}

ChunkBytes ChunkStore::start(std::size_t number, std::uint64_t least) const {
  const Chunk& chunk = chunks_.at(number);
  if (chunk.compression == Compression::None) {
    file_.requireWhole();
    return {chunk.packed, nullptr};
  }
  if (least < chunk.size / 2) {
    const std::shared_ptr<Slot> slot = slotOf(number);
    const std::lock_guard<std::mutex> lock(slot->filling);
    if (slot->checked) return {{slot->bytes.get(), static_cast<std::size_t>(chunk.size)}, slot->bytes};
    if (slot->start_size >= least || expandStart(chunk, least, *slot))
      return {{slot->start.get(), slot->start_size}, slot->start};
  }
  return bytes(number);
}

bool ChunkStore::expandStart(const Chunk& chunk, std::uint64_t least, Slot& slot) const {
  // Twice as much as before: then many calls do not take more time than expanding everything a few times.
  const auto size = static_cast<std::size_t>(
      std::min<std::uint64_t>(std::max<std::uint64_t>(least, 2 * slot.start_size), chunk.size));
  const std::shared_ptr<char[]> bytes(new char[size > 0 ? size : 1]);
  if (!expandFirst(chunk.compression, chunk.packed, bytes.get(), size)) return false;
  file_.requireWhole();
  finishedWith(chunk.packed.substr(0, size));
  slot.start = bytes;
  slot.start_size = size;
  return true;
}

void ChunkStore::finishedWith(std::string_view part) const {
  const auto end = [](std::string_view bytes) { return bytes.data() + bytes.size(); };
  const std::less<> before;
  if (part.empty() || before(part.data(), file().data()) || before(end(file()), end(part))) return;
  const std::lock_guard<std::mutex> lock(finished_mutex_);
  if (finished_.empty()) finished_ = part;
  const char* const first = std::min(part.data(), finished_.data());
  finished_ = {first, static_cast<std::size_t>(std::max(end(part), end(finished_)) - first)};
  finished_bytes_ += std::max(part.size(), kReadAhead);
  if (finished_bytes_ < kMostFinishedBytes) return;
  file_.release(finished_);
  finished_ = {};
  finished_bytes_ = 0;
}

void ChunkStore::check(const Chunk& chunk, std::string_view bytes) const {
  file_.requireWhole();
  if (chunk.crc != 0 && crcOf(bytes) != chunk.crc) fail(0, chunk.byte, "the chunk is damaged: its CRC is wrong");
  finishedWith(bytes);
}

std::shared_ptr<ChunkStore::Slot> ChunkStore::slotOf(std::size_t number) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = places_.find(number);
  if (found != places_.end()) {
    kept_.splice(kept_.begin(), kept_, found->second);
    return found->second->second;
  }
  // If chunks are needed again soon after they were dropped, again and again, messages of many chunks are interleaved
  // in time. Then more chunks are kept, because expanding a chunk for each message could take hours.
  const auto dropped = dropped_.find(number);
  if (dropped != dropped_.end() && drops_ - dropped->second <= 2 * kept_.size() + 4 &&
      ++returns_ > kReturns * kept_.size()) {
    keep_bytes_ = std::min(2 * keep_bytes_, kMostKeptBytes);
    returns_ = 0;
  }
  kept_.emplace_front(number, std::make_shared<Slot>());
  places_[number] = kept_.begin();
  kept_bytes_ += chunks_[number].size;
  while (kept_bytes_ > keep_bytes_ && kept_.size() > 1) {
    kept_bytes_ -= chunks_[kept_.back().first].size;
    places_.erase(kept_.back().first);
    dropped_[kept_.back().first] = ++drops_;
    kept_.pop_back();
  }
  return kept_.front().second;
}

std::shared_ptr<const char[]> ChunkStore::expanded(const Chunk& chunk) const {
  const auto size = static_cast<std::size_t>(chunk.size);
  const std::size_t behind = roomBehind(chunk.compression);                                // its pages need no memory
  const std::shared_ptr<char[]> bytes(new char[std::max<std::size_t>(size + behind, 1)]);  // not filled with zeros
  const std::string error = expand(chunk.compression, chunk.packed, bytes.get(), size, behind);
  file_.requireWhole();
  if (!error.empty()) fail(0, chunk.byte, "the chunk (" + nameOf(chunk.compression) + ") " + error);
  finishedWith(chunk.packed);
  return bytes;
}

std::string ChunkStore::placeOf(std::size_t number, std::uint64_t offset) const {
  const std::string byte = "byte " + std::to_string(offset);
  return number == 0 ? byte : byte + " of the chunk at byte " + std::to_string(chunks_[number].byte);
}

void ChunkStore::fail(std::size_t number, std::uint64_t offset, const std::string& what) const {
  throw FileError(shown_, placeOf(number, offset) + ": " + what);
}

}  // namespace gaussmap::detail
