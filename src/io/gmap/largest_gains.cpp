// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/largest_gains.h"

#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace gaussmap::detail {
namespace {

constexpr int kDigitBits = 16;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
constexpr std::uint64_t kSign = std::uint64_t{1} << 63;

/// Returns a whole number for a double. The whole numbers have the same order as the doubles.
std::uint64_t ordered(double value) {
  const double positive_zero = value + 0.0;  // -0.0 equals 0.0
  std::uint64_t bits = 0;
  std::memcpy(&bits, &positive_zero, sizeof bits);
  return bits & kSign ? ~bits : bits | kSign;
}

double fromOrdered(std::uint64_t number) {
  const std::uint64_t bits = number & kSign ? number & ~kSign : ~number;
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

GainThreshold largestGains(std::size_t count, const std::function<void(const std::function<void(double)>&)>& visitAll) {
  if (count == 0) return {std::numeric_limits<double>::infinity(), 0};
  std::uint64_t prefix = 0;  // the digits of the threshold found so far, from the highest
  for (int shift = 64 - kDigitBits; shift >= 0; shift -= kDigitBits) {
    std::vector<std::size_t> with_digit(kDigits, 0);
    visitAll([&](double gain) {
      const std::uint64_t number = ordered(gain);
      if (shift + kDigitBits == 64 || number >> (shift + kDigitBits) == prefix)
        ++with_digit[(number >> shift) & (kDigits - 1)];
    });
    std::size_t digit = kDigits;
    while (digit > 0 && with_digit[digit - 1] < count) count -= with_digit[--digit];
    if (digit == 0) return {-std::numeric_limits<double>::infinity(), 0};  // fewer than `count` gains
    prefix = prefix << kDigitBits | (digit - 1);
  }
  return {fromOrdered(prefix), count};
}

}  // namespace gaussmap::detail
