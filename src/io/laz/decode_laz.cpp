// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/files/mapped_file.h"
#include "io/las/las_bytes.h"
#include "io/laz/laz_file.h"

namespace gaussmap::detail {

namespace {

constexpr std::size_t kGroup = 512;  // points that are decoded together

class LazDecoding {
 public:
  LazDecoding(const LazSource& source, unsigned layers,
              const std::function<void(const char* records, std::size_t count)>& take)
      : source_(source),
        bytes_(source.file->bytes()),
        decoder_(source.layout.is_layered ? layeredDecoder(source.layout.items, layers)
                                          : pointwiseDecoder(source.layout.items)),
        take_(take),
        records_(kGroup * source.header.record_length) {}

  void decodeTable() {
    for (std::size_t i = 0; i < source_.chunks.table.size(); ++i) {
      const LazChunk& chunk = source_.chunks.table[i];
      const std::size_t size = decode(i, chunk);
      if (source_.layout.has_chunks && size != chunk.size && chunk.points > 1)
        fail(i, chunk, "its points end after " + std::to_string(size) + " of " + std::to_string(chunk.size) + " bytes");
    }
  }

  /// Finds each chunk behind the one before it.
  void decodeWithoutTable() {
    LazChunk chunk;
    chunk.offset = source_.chunks.first_byte;
    for (std::size_t i = 0; chunk.first_point < source_.header.points; ++i) {
      chunk.size = bytes_.size() - chunk.offset;
      const std::uint64_t left = source_.header.points - chunk.first_point;
      chunk.points = std::min(left, source_.layout.chunk_points);
      if (source_.layout.chunk_points == 0) chunk.points = pointsOf(chunk);
      if (chunk.points == 0 || chunk.points > left)
        fail(i, chunk, "it has " + std::to_string(chunk.points) + " points, but " + std::to_string(left) + " are left");
      chunk.offset += decode(i, chunk);
      chunk.first_point += chunk.points;
    }
  }

 private:
  [[noreturn]] void fail(std::size_t number, const LazChunk& chunk, const std::string& what) const {
    source_.file->requireWhole();
    throw FileError(source_.path, "chunk " + std::to_string(number) + " (byte " + std::to_string(chunk.offset) +
                                      ", from point " + std::to_string(chunk.first_point) + " on): " + what +
                                      ": the file is damaged");
  }

  /// Returns the number of points that a chunk of layers says; 0 if it has no room for the number.
  std::uint64_t pointsOf(const LazChunk& chunk) const {
    const std::size_t place = source_.header.record_length;
    if (chunk.size < place + sizeof(std::uint32_t)) return 0;
    return lasNumber<std::uint32_t>(bytes_.data() + chunk.offset + place);
  }

  /// Returns the number of bytes of the chunk.
  std::size_t decode(std::size_t number, const LazChunk& chunk) {
    std::string fault = decoder_->start(bytes_.substr(chunk.offset, chunk.size), chunk.points);
    if (!fault.empty()) fail(number, chunk, fault);
    for (std::uint64_t left = chunk.points; left > 0;) {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(left, kGroup));
      fault = decoder_->decode(count, records_.data());
      if (!fault.empty()) fail(number, chunk, fault);
      take_(records_.data(), count);
      left -= count;
    }
    return decoder_->bytes();
  }

  const LazSource& source_;
  std::string_view bytes_;
  std::unique_ptr<LazChunkDecoder> decoder_;
  const std::function<void(const char* records, std::size_t count)>& take_;
  std::vector<char> records_;
};

}  // namespace

void decodeLaz(const LazSource& source, unsigned layers,
               const std::function<void(const char* records, std::size_t count)>& take) {
  LazDecoding decoding(source, layers, take);
  if (source.chunks.table.empty())
    decoding.decodeWithoutTable();
  else
    decoding.decodeTable();
  source.file->requireWhole();
}

}  // namespace gaussmap::detail
