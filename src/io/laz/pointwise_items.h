// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "io/laz/arithmetic_decoder.h"
#include "io/laz/chunk_decoder.h"

namespace gaussmap::detail {

/// Decodes one item of the points of formats 0 to 5.
class PointwiseItem {
 public:
  virtual ~PointwiseItem() = default;
  /// Forgets everything and takes the item of the first point, which is not compressed.
  virtual void start(const char* first) = 0;
  /// Writes the item of the next point.
  virtual void decode(ArithmeticDecoder& coder, char* record) = 0;
  /// Returns true if the data are not valid.
  virtual bool failed() const { return false; }
};

/// The core of the record of formats 0 to 5, as in the file.
struct Point10 {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint16_t intensity = 0;
  std::uint8_t flags = 0;  // return number 0 to 2, number of returns 3 to 5, scan direction 6, edge of flight line 7
  std::uint8_t classification = 0;
  std::uint8_t scan_angle = 0;  // signed, but only sums modulo 256 are needed
  std::uint8_t user_data = 0;
  std::uint16_t source = 0;

  unsigned returnNumber() const { return flags & 7u; }
  unsigned returns() const { return flags >> 3 & 7u; }
  unsigned scanDirection() const { return flags >> 6 & 1u; }
};
static_assert(sizeof(Point10) == 20, "has no padding");
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "records are copied");

/// Adds a difference modulo 2^32.
inline void addWrapped(std::int32_t& value, std::int32_t difference) {
  value = static_cast<std::int32_t>(static_cast<std::uint32_t>(value) + static_cast<std::uint32_t>(difference));
}

/// Return the decoders of the two versions of the items.
std::unique_ptr<PointwiseItem> pointwiseItemV1(const LazItem& item);
std::unique_ptr<PointwiseItem> pointwiseItemV2(const LazItem& item);

}  // namespace gaussmap::detail
