// SPDX-License-Identifier: BSD-3-Clause
#include "core/number_text.h"

#include <charconv>
#include <cmath>

namespace gaussmap::detail {
namespace {

constexpr double kLargestPlain = 1e15;  // longer whole numbers are easier to read with an exponent

}  // namespace

std::string numberText(double value) {
  if (std::isnan(value)) return "nan";  // the sign of a NaN has no meaning
  char digits[40];
  const bool plain = std::abs(value) < kLargestPlain && std::trunc(value) == value;
  const std::to_chars_result end = plain
                                       ? std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed)
                                       : std::to_chars(digits, digits + sizeof digits, value);
  return {digits, end.ptr};
}

}  // namespace gaussmap::detail
