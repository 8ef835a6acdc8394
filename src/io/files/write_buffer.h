// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>
#include <string>

#include "io/files/atomic_file.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "values are written as they are in memory");

namespace gaussmap::detail {

/// Collects values for a file and writes them in large pieces. Call flush() after the last value.
class WriteBuffer {
 public:
  explicit WriteBuffer(AtomicFile& file) : file_(file) {}
  template <typename T>
  void add(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
    if (bytes_.size() >= kBytesAtOnce) flush();
  }
  void addText(const std::string& text) {
    bytes_ += text;
    if (bytes_.size() >= kBytesAtOnce) flush();
  }
  void flush() {
    file_.write(bytes_.data(), bytes_.size());
    bytes_.clear();
  }

 private:
  static constexpr std::size_t kBytesAtOnce = std::size_t{1} << 20;
  AtomicFile& file_;
  std::string bytes_;
};

}  // namespace gaussmap::detail
