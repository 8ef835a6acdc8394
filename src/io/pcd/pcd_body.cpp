// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/pcd_body.h"

#include <lzf.h>

#include <cstdint>
#include <cstring>

namespace gaussmap::detail {
namespace {

// DATA binary_compressed starts with two 32-bit numbers: the compressed size and the expanded size in bytes.
constexpr std::size_t kSizesBytes = 8;
// The maximum of LZF: a back reference of 3 bytes expands to 264 bytes.
constexpr std::size_t kMaxExpansion = 264 / 3;

struct CompressedSizes {
  std::uint32_t compressed = 0;
  std::uint32_t expanded = 0;
};

CompressedSizes sizesOf(std::string_view data) {
  CompressedSizes sizes;
  std::memcpy(&sizes.compressed, data.data(), 4);
  std::memcpy(&sizes.expanded, data.data() + 4, 4);
  return sizes;
}

[[noreturn]] void fail(const std::filesystem::path& path, std::size_t byte, const std::string& what) {
  throw FileError(path, "byte " + std::to_string(byte) + ": " + what);
}

std::size_t bytesWithoutPadding(const PcdHeader& header) {
  std::size_t bytes = header.record_size;
  for (const PcdField& field : header.fields)
    if (field.name == "_") bytes -= field.size * field.count;
  return bytes;
}

std::string claim(std::size_t points, std::size_t each, const std::string& what) {
  return std::to_string(points) + " points of " + std::to_string(each) + " " + what;
}

void checkAscii(const std::filesystem::path& path, const PcdHeader& header, std::string_view data) {
  // A number takes at least two bytes: one digit and one separator.
  std::size_t numbers = 0;
  if (__builtin_mul_overflow(header.points, header.columns, &numbers) || numbers > (data.size() + 1) / 2)
    throw FileError(path, "the header claims " + claim(header.points, header.columns, "numbers each") + ", but only " +
                              std::to_string(data.size()) +
                              " bytes of text follow: the file is cut off "
                              "or POINTS, WIDTH or COUNT are wrong");
}

void checkBinary(const std::filesystem::path& path, const PcdHeader& header, std::string_view data) {
  std::size_t bytes = 0;
  if (__builtin_mul_overflow(header.points, header.record_size, &bytes) || bytes > data.size())
    fail(
        path, header.data_offset + data.size(),
        "the data end here after " + std::to_string(data.size()) + " bytes, the header claims " +
            claim(header.points, header.record_size, "bytes: the file is cut off or POINTS, WIDTH or COUNT are wrong"));
}

void checkCompressed(const std::filesystem::path& path, const PcdHeader& header, std::string_view data) {
  if (header.points == 0) return;
  if (data.size() < kSizesBytes)
    fail(path, header.data_offset + data.size(), "the data end inside the two sizes of binary_compressed");
  const CompressedSizes sizes = sizesOf(data);
  if (sizes.compressed > data.size() - kSizesBytes)
    fail(path, header.data_offset,
         std::to_string(sizes.compressed) + " bytes of compressed data are claimed, but " +
             std::to_string(data.size() - kSizesBytes) + " follow: the file is cut off or damaged");
  std::size_t bytes = 0;
  bool fits = !__builtin_mul_overflow(header.points, header.record_size, &bytes) && bytes == sizes.expanded;
  fits =
      fits || (!__builtin_mul_overflow(header.points, bytesWithoutPadding(header), &bytes) && bytes == sizes.expanded);
  if (!fits)
    fail(path, header.data_offset + 4,
         "the data expand to " + std::to_string(sizes.expanded) + " bytes, but the header claims " +
             claim(header.points, header.record_size, "bytes"));
  if (sizes.expanded > kMaxExpansion * sizes.compressed)
    fail(path, header.data_offset + 4,
         std::to_string(sizes.compressed) + " compressed bytes cannot expand to " + std::to_string(sizes.expanded) +
             ": the file is damaged");
}

}  // namespace

void checkPcdBody(const std::filesystem::path& path, const PcdHeader& header, std::string_view data) {
  switch (header.encoding) {
    case PcdEncoding::Ascii:
      return checkAscii(path, header, data);
    case PcdEncoding::Binary:
      return checkBinary(path, header, data);
    case PcdEncoding::BinaryCompressed:
      return checkCompressed(path, header, data);
  }
}

PcdExpanded::PcdExpanded(const std::filesystem::path& path, const PcdHeader& header, std::string_view data)
    : header_(header) {
  if (header.points == 0) return;
  const CompressedSizes sizes = sizesOf(data);
  has_padding_ = sizes.expanded == header.points * header.record_size;
  bytes_.reset(new char[sizes.expanded]);  // not zeroed, because every byte is written below
  const unsigned expanded = lzf_decompress(data.data() + kSizesBytes, sizes.compressed, bytes_.get(), sizes.expanded);
  if (expanded != sizes.expanded)
    fail(path, header.data_offset + kSizesBytes,
         "the compressed data are damaged: they do not expand to the claimed " + std::to_string(sizes.expanded) +
             " bytes");
}

PcdStride PcdExpanded::strideOf(const PcdField& wanted) const {
  std::size_t offset = 0;
  for (const PcdField& field : header_.fields) {
    if (&field == &wanted) break;
    if (has_padding_ || field.name != "_") offset += header_.points * field.size * field.count;
  }
  return {offset, wanted.size * wanted.count};
}

}  // namespace gaussmap::detail
