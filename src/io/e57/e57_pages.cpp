// SPDX-License-Identifier: BSD-3-Clause
#include "io/e57/e57_pages.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "gaussmap/core/error.h"
#include "io/e57/crc32c.h"
#include "io/e57/e57_file.h"

namespace gaussmap::detail {
namespace {

constexpr std::size_t kHeaderBytes = 48;
// The standard always uses pages of 1024 bytes. The upper limit keeps damaged headers from being believed.
constexpr std::uint64_t kSmallestPage = 64, kLargestPage = std::uint64_t{1} << 20;

template <typename T>
T littleEndianAt(std::string_view bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

std::string hexadecimal(std::uint32_t number) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "0x";
  for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[(number >> shift) & 15u];
  return text;
}

}  // namespace

E57Pages::E57Pages(const std::filesystem::path& path) : path_(path), file_(path) {
  readHeader();
  verified_ = std::make_unique<std::atomic<bool>[]>(
      static_cast<std::size_t>(header_.file_bytes / header_.page_bytes));  // all false
}

void E57Pages::readHeader() {
  const std::string_view bytes = file_.bytes();
  if (!isE57(bytes)) throw FileError(path_, "is not an E57 file: it does not start with ASTM-E57");
  if (bytes.size() < kHeaderBytes)
    throw FileError(path_, "has " + std::to_string(bytes.size()) + " bytes, but the header of an E57 file has " +
                               std::to_string(kHeaderBytes) + ": the file was cut off");
  header_.major_version = littleEndianAt<std::uint32_t>(bytes, 8);
  header_.minor_version = littleEndianAt<std::uint32_t>(bytes, 12);
  header_.file_bytes = littleEndianAt<std::uint64_t>(bytes, 16);
  header_.xml_offset = littleEndianAt<std::uint64_t>(bytes, 24);
  header_.xml_bytes = littleEndianAt<std::uint64_t>(bytes, 32);
  header_.page_bytes = littleEndianAt<std::uint64_t>(bytes, 40);
  if (header_.major_version != 1)
    throw FileError(path_, "is an E57 file of version " + std::to_string(header_.major_version) + "." +
                               std::to_string(header_.minor_version) + ", but only version 1 is known");
  if (header_.page_bytes < kSmallestPage || header_.page_bytes > kLargestPage || header_.page_bytes % 4 != 0)
    throw FileError(path_, "byte 40: the pages have " + std::to_string(header_.page_bytes) +
                               " bytes, expected 1024: the header is damaged");
  if (header_.file_bytes > bytes.size())
    throw FileError(path_, "has " + std::to_string(bytes.size()) + " bytes, but its header gives " +
                               std::to_string(header_.file_bytes) + ": the file was cut off");
  if (header_.file_bytes == 0 || header_.file_bytes % header_.page_bytes != 0)
    throw FileError(path_, "byte 16: the length of the file is " + std::to_string(header_.file_bytes) +
                               ", not a multiple of the page size " + std::to_string(header_.page_bytes) +
                               ": the header is damaged");
}

std::uint64_t E57Pages::logicalOffset(std::uint64_t physical, std::uint64_t bytes, const std::string& what) const {
  const std::string place = what + " is at byte " + std::to_string(physical);
  if (physical >= header_.file_bytes)
    throw FileError(path_, place + ", but the file has only " + std::to_string(header_.file_bytes) + " bytes");
  if (physical % header_.page_bytes >= pageData())
    throw FileError(path_, place + ", which is inside the checksum of a page");
  const std::uint64_t logical = physical / header_.page_bytes * pageData() + physical % header_.page_bytes;
  if (bytes > logicalBytes() - logical)
    throw FileError(path_, place + " and has " + std::to_string(bytes) + " bytes, but only " +
                               std::to_string(logicalBytes() - logical) + " bytes follow in the file");
  return logical;
}

void E57Pages::verify(std::size_t page) const {
  if (verified_[page].load(std::memory_order_relaxed)) return;
  const auto length = static_cast<std::size_t>(header_.page_bytes);
  const std::string_view bytes = file_.bytes().substr(page * length, length);
  const std::string_view data = bytes.substr(0, length - sizeof(std::uint32_t));
  const std::uint32_t stored = __builtin_bswap32(littleEndianAt<std::uint32_t>(bytes, data.size()));
  const std::uint32_t computed = crc32c(data);
  if (stored != computed)
    throw FileError(path_, "page " + std::to_string(page) + " (bytes " + std::to_string(page * length) + " to " +
                               std::to_string((page + 1) * length - 1) + "): the checksum is " + hexadecimal(stored) +
                               ", but the data have " + hexadecimal(computed) +
                               ": the file is damaged, copy it again from its source");
  verified_[page].store(true, std::memory_order_relaxed);
}

void E57Pages::copy(std::uint64_t logical, std::size_t bytes, char* to) const {
  if (logical > logicalBytes() || bytes > logicalBytes() - logical)
    throw FileError(path_, "the file ends inside " + std::to_string(bytes) + " bytes of data at byte " +
                               std::to_string(physicalOffset(logical)));
  const auto page_data = static_cast<std::size_t>(pageData());
  auto page = static_cast<std::size_t>(logical / page_data);
  auto offset = static_cast<std::size_t>(logical % page_data);
  for (; bytes > 0; ++page, offset = 0) {
    verify(page);
    const std::size_t piece = std::min(bytes, page_data - offset);
    std::memcpy(to, file_.bytes().data() + page * static_cast<std::size_t>(header_.page_bytes) + offset, piece);
    to += piece;
    bytes -= piece;
  }
}

}  // namespace gaussmap::detail
