// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

namespace gaussmap::detail {

inline std::uint64_t bitsOf(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline std::uint64_t bitsOf(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

inline float floatFromBits(std::uint64_t bits) {
  const auto low = static_cast<std::uint32_t>(bits);
  float value = 0.0f;
  std::memcpy(&value, &low, sizeof value);
  return value;
}

inline double fromBits(std::uint64_t bits) {
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// Writes columns of numbers: first the lowest byte of all numbers, then the next byte, and so on. Neighbours in a map
/// differ only in the low bytes, so the other bytes compress well.
class ColumnWriter {
 public:
  explicit ColumnWriter(std::string& bytes) : bytes_(bytes) {}
  template <typename ValueAt>
  void write(std::size_t count, int width, const ValueAt& value) {
    const std::size_t begin = bytes_.size();
    bytes_.resize(begin + count * static_cast<std::size_t>(width));
    char* out = bytes_.data() + begin;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint64_t bits = value(i);
      for (int byte = 0; byte < width; ++byte)
        out[static_cast<std::size_t>(byte) * count + i] = static_cast<char>(bits >> (8 * byte));
    }
  }

 private:
  std::string& bytes_;
};

class ColumnReader {
 public:
  ColumnReader(const char* bytes, std::size_t size) : next_(bytes), left_(size) {}
  template <typename Take>
  void read(std::size_t count, int width, const Take& take) {
    const std::size_t size = count * static_cast<std::size_t>(width);
    if (size > left_) throw std::runtime_error("shorter than its cells need");
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t bits = 0;
      for (int byte = 0; byte < width; ++byte)
        bits |= std::uint64_t{static_cast<unsigned char>(next_[static_cast<std::size_t>(byte) * count + i])}
                << (8 * byte);
      take(i, bits);
    }
    next_ += size;
    left_ -= size;
  }
  std::size_t left() const { return left_; }

 private:
  const char* next_;
  std::size_t left_;
};

}  // namespace gaussmap::detail
