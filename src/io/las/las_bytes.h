// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <string_view>

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "LAS files are little-endian, and no bytes are swapped");

namespace gaussmap::detail {

/// Returns the number of type T that is stored at `place`, which does not need to be aligned.
template <typename T>
T lasNumber(const char* place) {
  T value;
  std::memcpy(&value, place, sizeof(T));
  return value;
}

/// Returns a text field of fixed length without the zeros behind it.
inline std::string_view lasText(std::string_view field) {
  return field.substr(0, field.find('\0'));
}

}  // namespace gaussmap::detail
