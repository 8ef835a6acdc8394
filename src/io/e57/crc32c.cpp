// SPDX-License-Identifier: BSD-3-Clause
#include "io/e57/crc32c.h"

#include <array>
#include <cstddef>
#include <cstring>

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "eight bytes at once are read as they are in memory");

namespace gaussmap::detail {
namespace {

using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

/// Entry [k][b] is the checksum of byte b followed by k zeros, without the two inversions.
constexpr CrcTables makeCrcTables() {
  constexpr std::uint32_t kReversedPolynomial = 0x82F63B78u;
  CrcTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? kReversedPolynomial : 0u);
    tables[0][byte] = crc;
  }
  for (std::size_t zeros = 1; zeros < 8; ++zeros)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = tables[zeros - 1][byte];
      tables[zeros][byte] = (crc >> 8) ^ tables[0][crc & 0xFFu];
    }
  return tables;
}

constexpr CrcTables kCrcTables = makeCrcTables();

}  // namespace

std::uint32_t crc32c(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  const char* place = bytes.data();
  std::size_t left = bytes.size();
  for (; left >= 8; left -= 8, place += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, place, sizeof(word));
    word ^= crc;
    crc = 0;
    for (std::size_t i = 0; i < 8; ++i) crc ^= kCrcTables[7 - i][(word >> (8 * i)) & 0xFFu];
  }
  for (; left > 0; --left, ++place)
    crc = (crc >> 8) ^ kCrcTables[0][(crc ^ static_cast<unsigned char>(*place)) & 0xFFu];
  return ~crc;
}

}  // namespace gaussmap::detail
