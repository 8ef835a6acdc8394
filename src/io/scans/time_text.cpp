// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/time_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace gaussmap::detail {
namespace {

constexpr int kMaxDigits = 19;                      // 10^19 fits into 64 bits
constexpr double kEarliest = 1e8, kLatest = 4.2e9;  // 1973 and 2103 [s]

double scaleOf(TimeUnit unit) {
  return std::pow(10.0, -3 * static_cast<int>(unit));
}

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

std::string unitName(TimeUnit unit) {
  constexpr const char* kNames[] = {"s", "ms", "us", "ns"};
  return kNames[static_cast<int>(unit)];
}

TimeUnit unitByMagnitude(double largest) {
  return largest < 1e11   ? TimeUnit::Seconds
         : largest < 1e14 ? TimeUnit::Milliseconds
         : largest < 1e17 ? TimeUnit::Microseconds
                          : TimeUnit::Nanoseconds;
}

bool isTimeOfDay(double number) {
  const double seconds = number * scaleOf(unitByMagnitude(number));
  return seconds >= kEarliest && seconds <= kLatest;
}

double largestOf(const std::vector<Decimal>& numbers) {
  double largest = 0.0;
  for (const Decimal& number : numbers) largest = std::max(largest, std::abs(number.value()));
  return largest;
}

std::optional<Instant> toTime(const Decimal& number, TimeUnit unit) {
  std::uint64_t ticks = number.digits;
  int exponent = number.exponent + 9 - 3 * static_cast<int>(unit);
  for (; exponent > 0 && ticks > 0; --exponent) {
    if (ticks > std::numeric_limits<std::uint64_t>::max() / 10) return std::nullopt;
    ticks *= 10;
  }
  for (; exponent < 0 && ticks > 0; ++exponent) ticks = exponent == -1 ? ticks / 10 + (ticks % 10 >= 5) : ticks / 10;
  if (ticks > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() / 4)) return std::nullopt;
  const auto signed_ticks = static_cast<std::int64_t>(ticks);
  return Instant(number.negative ? -signed_ticks : signed_ticks);
}

double secondsOf(Instant time) {
  // Whole seconds and the rest apart, so that the sum is rounded once.
  constexpr std::int64_t kBillion = 1000000000;
  const std::int64_t seconds = time.count() / kBillion, rest = time.count() % kBillion;
  return static_cast<double>(seconds) + static_cast<double>(rest) * 1e-9;
}

std::string timeText(Instant time) {
  constexpr std::int64_t kBillion = 1000000000;
  const std::int64_t ticks = std::abs(time.count());
  std::string fraction = std::to_string(kBillion + ticks % kBillion).substr(1);
  fraction.erase(fraction.find_last_not_of('0') + 1);
  return (time.count() < 0 ? "-" : "") + std::to_string(ticks / kBillion) + (fraction.empty() ? "" : "." + fraction) +
         " s";
}

}  // namespace gaussmap::detail
