// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace gaussmap::detail {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "recordings are little-endian");

/// Takes little-endian values from the front of some bytes. After the end it returns zeros, and ok() returns false.
class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes) : rest_(bytes) {}

  template <typename Number>
  Number take() {
    Number value{};
    const std::string_view raw = takeBytes(sizeof(Number));
    if (ok_) std::memcpy(&value, raw.data(), sizeof(Number));
    return value;
  }
  std::string_view takeBytes(std::uint64_t size) {
    if (size > rest_.size()) {
      ok_ = false;
      rest_ = {};
      return {};
    }
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  /// Takes bytes whose number is stored before them in 32 bits.
  std::string_view takeText() { return takeBytes(take<std::uint32_t>()); }

  bool ok() const { return ok_; }
  bool empty() const { return rest_.empty(); }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

}  // namespace gaussmap::detail
