// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "gaussmap/core/error.h"
#include "io/las/las_bytes.h"
#include "io/laz/arithmetic_decoder.h"
#include "io/laz/integer_decoder.h"
#include "io/laz/laz_layout.h"

namespace gaussmap::detail {

namespace {

constexpr std::size_t kTableOffset = sizeof(std::int64_t);  // bytes before the first chunk
constexpr std::size_t kTableHeader = 8;                     // bytes: version, number of chunks

class LazChunkFinder {
 public:
  LazChunkFinder(const std::filesystem::path& path, std::string_view bytes, const LasHeader& header,
                 const LazLayout& layout)
      : path_(path), bytes_(bytes), header_(header), layout_(layout) {}

  LazChunks find() {
    chunks_.first_byte = header_.data_offset;
    if (!layout_.has_chunks) {
      if (header_.points > 0)
        chunks_.table.push_back({header_.data_offset, bytes_.size() - header_.data_offset, 0, header_.points});
      return std::move(chunks_);
    }
    if (bytes_.size() - header_.data_offset < kTableOffset) {
      if (header_.points == 0) return std::move(chunks_);
      fail(header_.data_offset, "the file ends before the first point: it is cut off");
    }
    chunks_.first_byte = header_.data_offset + kTableOffset;
    const std::size_t table = tablePosition();
    if (table == 0) {
      if (layout_.chunk_points == 0 && !layout_.is_layered)
        fail(header_.data_offset, "the file has no table of chunks, and its chunks can have any number of points: it " +
                                      std::string("was not finished"));
      if (header_.points > 0)
        chunks_.warning = "the file has no table of chunks: it was not finished, or was written to a pipe";
      return std::move(chunks_);
    }
    readTable(table);
    return std::move(chunks_);
  }

 private:
  [[noreturn]] void fail(std::size_t place, const std::string& what) const {
    throw FileError(path_, "byte " + std::to_string(place) + ": " + what);
  }

  /// Returns true if a table of chunks can be at this position.
  bool isTable(std::uint64_t position) const {
    return position >= chunks_.first_byte && position <= bytes_.size() - kTableHeader &&
           lasNumber<std::uint32_t>(bytes_.data() + position) == 0;
  }

  /// Returns the position of the table; 0 if the file has no table.
  std::size_t tablePosition() const {
    const auto position = lasNumber<std::int64_t>(bytes_.data() + header_.data_offset);
    const auto first = static_cast<std::int64_t>(chunks_.first_byte);
    if (position == -1) {  // written to a pipe: the position is at the end of the file
      if (bytes_.size() - chunks_.first_byte < sizeof(std::int64_t) + kTableHeader) return 0;
      const auto last = lasNumber<std::uint64_t>(bytes_.data() + bytes_.size() - sizeof(std::int64_t));
      return isTable(last) ? last : 0;
    }
    // Writers put the position of the first chunk here until they know that of the table.
    if (position == first && header_.points > 0) return 0;
    if (position > static_cast<std::int64_t>(bytes_.size()))
      fail(header_.data_offset, "the table of chunks is at byte " + std::to_string(position) +
                                    ", but the file has only " + std::to_string(bytes_.size()) +
                                    " bytes: it is cut off");
    if (position < 0 || bytes_.size() < kTableHeader || !isTable(static_cast<std::uint64_t>(position))) {
      if (header_.points == 0) return 0;
      fail(header_.data_offset,
           "the table of chunks is said to be at byte " + std::to_string(position) + ", but it is not there");
    }
    return static_cast<std::size_t>(position);
  }

  void readTable(std::size_t position) {
    const std::uint64_t count = lasNumber<std::uint32_t>(bytes_.data() + position + 4);
    const std::size_t room = (position - chunks_.first_byte) / header_.record_length;
    const std::string has_chunks = "the table of chunks has " + std::to_string(count) + " chunks";
    if (header_.points == 0) {
      if (count > 0 && room > 0) fail(position + 4, has_chunks + ", but the header says 0 points");
      return;
    }
    if (count > room)
      fail(position + 4, has_chunks + ", but there is only room for " + std::to_string(room) + ": it is damaged");
    if (layout_.chunk_points > 0) {
      const std::uint64_t expected = (header_.points - 1) / layout_.chunk_points + 1;
      if (count != expected)
        fail(position + 4, has_chunks + ", but the header says " + std::to_string(header_.points) +
                               " points, which need " + std::to_string(expected) + " chunks of " +
                               std::to_string(layout_.chunk_points));
    }
    decodeTable(position, count);
  }

  void decodeTable(std::size_t position, std::uint64_t count) {
    ArithmeticDecoder coder(bytes_.substr(position + kTableHeader));
    IntegerDecoder numbers(32, 2);
    std::uint32_t points = 0, size = 0;
    std::size_t place = chunks_.first_byte;
    std::uint64_t first_point = 0;
    chunks_.table.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      if (layout_.chunk_points == 0) points = numbers.decode(coder, points, 0);
      size = numbers.decode(coder, size, 1);
      const std::uint64_t left = header_.points - first_point;
      const std::uint64_t in_chunk = layout_.chunk_points == 0 ? points : std::min(left, layout_.chunk_points);
      if (coder.failed() || size > position - place || in_chunk > left)
        fail(position, "the table of chunks is damaged: chunk " + std::to_string(i) + " has " +
                           std::to_string(in_chunk) + " points and " + std::to_string(size) + " bytes, but " +
                           std::to_string(left) + " points and " + std::to_string(position - place) +
                           " bytes are left");
      if (in_chunk > 0) chunks_.table.push_back({place, size, first_point, in_chunk});
      place += size;
      first_point += in_chunk;
    }
    if (first_point < header_.points)
      fail(position, "the chunks have " + std::to_string(first_point) + " points together, but the header says " +
                         std::to_string(header_.points));
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  const LasHeader& header_;
  const LazLayout& layout_;
  LazChunks chunks_;
};

}  // namespace

LazChunks findLazChunks(const std::filesystem::path& path, std::string_view bytes, const LasHeader& header,
                        const LazLayout& layout) {
  return LazChunkFinder(path, bytes, header, layout).find();
}

}  // namespace gaussmap::detail
