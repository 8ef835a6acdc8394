// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

// Numbers in binary files, in either byte order.
namespace gaussmap::detail {

/// The type of a number. The order is that of sensor_msgs/PointField.
enum class NumberType : std::uint8_t { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

/// Returns the number of bytes of a number.
std::size_t sizeOf(NumberType type);
/// Returns true for integers.
inline bool isWhole(NumberType type) {
  return type < NumberType::Float32;
}

/// Returns the bytes at `place` as a T, in reverse order if `swapped`.
template <typename T>
T loadNumber(const char* place, bool swapped) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, place, sizeof(T));
  if (swapped) std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// Converts `count` numbers that are `step` bytes apart to doubles.
void loadNumbers(NumberType type, bool swapped, const char* first, std::size_t step, std::size_t count, double* values);

}  // namespace gaussmap::detail
