// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/binary_numbers.h"

namespace gaussmap::detail {
namespace {

template <typename T, bool swapped>
void loadAll(const char* first, std::size_t step, std::size_t count, double* values) {
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<double>(loadNumber<T>(first + i * step, swapped));
}

/// Calls body with a value of the C++ type.
template <typename Body>
auto withNumberType(NumberType type, const Body& body) {
  switch (type) {
    case NumberType::Int8:
      return body(std::int8_t{});
    case NumberType::UInt8:
      return body(std::uint8_t{});
    case NumberType::Int16:
      return body(std::int16_t{});
    case NumberType::UInt16:
      return body(std::uint16_t{});
    case NumberType::Int32:
      return body(std::int32_t{});
    case NumberType::UInt32:
      return body(std::uint32_t{});
    case NumberType::Float32:
      return body(float{});
    default:
      return body(double{});
  }
}

}  // namespace

std::size_t sizeOf(NumberType type) {
  return withNumberType(type, [](auto zero) { return sizeof(zero); });
}

void loadNumbers(NumberType type, bool swapped, const char* first, std::size_t step, std::size_t count,
                 double* values) {
  withNumberType(type, [&](auto zero) {
    using T = decltype(zero);
    if (swapped)
      loadAll<T, true>(first, step, count, values);
    else
      loadAll<T, false>(first, step, count, values);
  });
}

}  // namespace gaussmap::detail
