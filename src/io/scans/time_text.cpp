// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/time_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaussmap::detail {
namespace {

constexpr double kEarliest = 1e8, kLatest = 4.2e9;  // 1973 and 2103 [s]

double scaleOf(TimeUnit unit) {
  return std::pow(10.0, -3 * static_cast<int>(unit));
}

}  // namespace

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
