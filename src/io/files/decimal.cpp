// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/decimal.h"

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace gaussmap::detail {
namespace {

constexpr int kMaxDigits = 19;  // 10^19 fits into 64 bits

bool isDecimalDigit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

double Decimal::value() const {
  const double magnitude = static_cast<double>(digits) * std::pow(10.0, exponent);
  return negative ? -magnitude : magnitude;
}

std::optional<Decimal> parseDecimal(std::string_view word) {
  Decimal number;
  std::size_t i = 0;
  if (i < word.size() && (word[i] == '+' || word[i] == '-')) number.negative = word[i++] == '-';
  int kept = 0;
  std::size_t seen = 0;
  bool point = false;
  for (; i < word.size() && (isDecimalDigit(word[i]) || (word[i] == '.' && !point)); ++i) {
    if (word[i] == '.') {
      point = true;
      continue;
    }
    ++seen;
    if (seen > 10000) return std::nullopt;  // the exponent would overflow
    if (kept < kMaxDigits) {
      number.digits = number.digits * 10 + static_cast<std::uint64_t>(word[i] - '0');
      if (number.digits > 0) ++kept;
      if (point) --number.exponent;
    } else if (!point) {
      ++number.exponent;
    }
  }
  if (seen == 0) return std::nullopt;
  number.whole = !point && seen == word.size();
  if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
    int exponent = 0;
    std::string_view rest = word.substr(i + 1);
    if (rest.size() > 1 && rest.front() == '+' && rest[1] != '-') rest.remove_prefix(1);
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), exponent);
    if (error != std::errc() || end != rest.data() + rest.size() || std::abs(exponent) > 10000) return std::nullopt;
    number.exponent += exponent;
    i = word.size();
  }
  if (i != word.size()) return std::nullopt;
  return number;
}

}  // namespace gaussmap::detail
