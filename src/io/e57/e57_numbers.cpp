// SPDX-License-Identifier: BSD-3-Clause
#include "io/e57/e57_numbers.h"

#include <cstdint>
#include <cstring>

namespace gaussmap::detail {
namespace {

template <typename T>
T loadAt(const char* place) {
  T value;
  std::memcpy(&value, place, sizeof(T));
  return value;
}

/// Reads unsigned integers of `bits` bits, which follow each other without gaps, the lowest bit first.
/// `bits` must be 1 to 64.
template <typename Use>
void forEachInteger(const char* bytes, unsigned bits, std::size_t first, std::size_t count, const Use& use) {
  const std::uint64_t mask = ~std::uint64_t{0} >> (64 - bits);
  std::uint64_t bit = std::uint64_t{first} * bits;
  if (bits <= 57) {  // with a shift of up to 7 bits, one word is enough
    for (std::size_t i = 0; i < count; ++i, bit += bits)
      use(i, (loadAt<std::uint64_t>(bytes + bit / 8) >> (bit % 8)) & mask);
    return;
  }
  for (std::size_t i = 0; i < count; ++i, bit += bits) {
    const unsigned shift = bit % 8;
    std::uint64_t word = loadAt<std::uint64_t>(bytes + bit / 8) >> shift;
    if (shift > 0) word |= std::uint64_t{static_cast<unsigned char>(bytes[bit / 8 + 8])} << (64 - shift);
    use(i, word & mask);
  }
}

/// Writes integer * scale + offset. Returns false if an integer is greater than `range`.
bool decodeIntegers(const E57Field& field, unsigned bits, const char* bytes, std::size_t first, std::size_t count,
                    double* values) {
  const std::uint64_t range = field.range();
  const auto minimum = static_cast<std::uint64_t>(field.minimum);
  bool is_outside = false;
  const auto number = [&](std::uint64_t stored) {
    is_outside |= stored > range;
    return static_cast<double>(static_cast<std::int64_t>(minimum + stored));
  };
  if (field.encoding == E57Encoding::Integer)
    forEachInteger(bytes, bits, first, count, [&](std::size_t i, std::uint64_t stored) { values[i] = number(stored); });
  else
    forEachInteger(bytes, bits, first, count, [&](std::size_t i, std::uint64_t stored) {
      values[i] = number(stored) * field.scale + field.offset;
    });
  return !is_outside;
}

double constantOf(const E57Field& field) {
  const auto number = static_cast<double>(field.minimum);
  return field.encoding == E57Encoding::ScaledInteger ? number * field.scale + field.offset : number;
}

}  // namespace

std::size_t decodeE57(const E57Field& field, const char* bytes, std::size_t first, std::size_t count, double* values) {
  switch (field.encoding) {
    case E57Encoding::Single:
      for (std::size_t i = 0; i < count; ++i)
        values[i] = static_cast<double>(loadAt<float>(bytes + (first + i) * sizeof(float)));
      return count;
    case E57Encoding::Double:
      if (count > 0) std::memcpy(values, bytes + first * sizeof(double), count * sizeof(double));
      return count;
    case E57Encoding::String:
      return 0;
    default:
      break;
  }
  const unsigned bits = field.bits();
  if (bits == 0) {
    for (std::size_t i = 0; i < count; ++i) values[i] = constantOf(field);
    return count;
  }
  if (decodeIntegers(field, bits, bytes, first, count, values)) return count;
  std::size_t good = count;
  forEachInteger(bytes, bits, first, count, [&](std::size_t i, std::uint64_t stored) {
    if (stored > field.range() && i < good) good = i;
  });
  return good;
}

}  // namespace gaussmap::detail
