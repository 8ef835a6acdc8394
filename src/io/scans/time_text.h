// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gaussmap/version.h"
#include "io/files/decimal.h"

// Times as text. A double does not hold nanoseconds since 1970, so times stay decimal until they become integers.
namespace gaussmap::detail {

/// A time since the zero of some clock.
using Instant = std::chrono::nanoseconds;

enum class TimeUnit { Seconds, Milliseconds, Microseconds, Nanoseconds };
inline constexpr TimeUnit kTimeUnits[] = {TimeUnit::Seconds, TimeUnit::Milliseconds, TimeUnit::Microseconds,
                                          TimeUnit::Nanoseconds};

/// Returns "s", "ms", "us" or "ns".
std::string unitName(TimeUnit unit);

/// Returns the unit in which a number of this magnitude is a time of today. Small numbers, such as the time since the
/// start of a log, are seconds.
GAUSSMAP_API TimeUnit unitByMagnitude(double largest);

/// Returns true if the number is a time between 1973 and 2103 in the unit of its magnitude.
GAUSSMAP_API bool isTimeOfDay(double number);

/// Returns the largest magnitude of the numbers.
double largestOf(const std::vector<Decimal>& numbers);

/// Returns nullopt if the time is out of range (292 years).
GAUSSMAP_API std::optional<Instant> toTime(const Decimal& number, TimeUnit unit);

/// Returns the time in seconds.
double secondsOf(Instant time);
/// Returns a time for messages: "1689000000.123456 s".
std::string timeText(Instant time);

}  // namespace gaussmap::detail
