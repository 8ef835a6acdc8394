// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/name_dates.h"

#include <algorithm>
#include <ctime>
#include <initializer_list>
#include <string>

namespace gaussmap::detail {
namespace {

using Row = std::vector<DigitRun>;

/// The lengths of the runs of a date and a time of day.
const std::vector<std::vector<std::size_t>>& shapes() {
  static const std::vector<std::vector<std::size_t>> all = {
      {4, 2, 2, 2, 2, 2}, {8, 2, 2, 2}, {4, 2, 2, 6}, {8, 6}, {8, 9}, {4, 2, 2, 9}, {14}, {17}};
  return all;
}

int numberIn(std::string_view digits, std::size_t first, std::size_t count) {
  int number = 0;
  for (const char c : digits.substr(first, count)) number = number * 10 + (c - '0');
  return number;
}

/// Returns the seconds of the digits YYYYMMDDhhmmss; nullopt if they are not a date after 1980.
std::optional<long long> secondsOfDate(std::string_view digits) {
  std::tm date{};
  date.tm_year = numberIn(digits, 0, 4) - 1900;
  date.tm_mon = numberIn(digits, 4, 2) - 1;
  date.tm_mday = numberIn(digits, 6, 2);
  date.tm_hour = numberIn(digits, 8, 2);
  date.tm_min = numberIn(digits, 10, 2);
  date.tm_sec = numberIn(digits, 12, 2);
  const bool is_leap_second = date.tm_sec == 60;
  if (date.tm_year < 80 || date.tm_year > 200) return std::nullopt;
  std::tm same = date;
  const std::time_t seconds = timegm(&same);  // carries numbers that are too large: the 31st of April is a day in May
  if (!is_leap_second && (same.tm_mon != date.tm_mon || same.tm_mday != date.tm_mday || same.tm_hour != date.tm_hour ||
                          same.tm_min != date.tm_min || same.tm_sec != date.tm_sec))
    return std::nullopt;
  return seconds;
}

bool isDateSeparator(char c) {
  return c == '-' || c == '_' || c == 'T' || c == 't' || c == ':' || c == '.' || c == ' ' || c == '/';
}

/// A date of one name, and the digits of its fraction of a second.
struct Date {
  long long seconds = 0;
  std::string fraction;
};

/// Reads the date whose first run is `start`. The run behind it is a fraction if `with_fraction` is set.
std::optional<Date> dateAt(const Row& row, std::size_t start, const std::vector<std::size_t>& shape,
                           bool with_fraction) {
  std::string digits;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const DigitRun& run = row[start - i];
    if (run.digits.size() != shape[i] || (i > 0 && !isDateSeparator(run.before))) return std::nullopt;
    digits += run.digits;
  }
  const std::optional<long long> seconds = secondsOfDate(digits);
  if (!seconds) return std::nullopt;
  Date date{*seconds, digits.substr(14)};
  if (with_fraction) date.fraction += row[start - shape.size()].digits;
  return date;
}

/// Returns true if the run behind the date is a fraction of a second in all names. Behind an underscore or a hyphen, it
/// can also be the number of the scan.
bool hasFraction(const std::vector<Row>& rows, std::size_t last, bool seconds_differ) {
  if (last == 0) return false;
  const char before = rows.front()[last - 1].before;
  const std::size_t size = rows.front()[last - 1].digits.size();
  const auto all = [&](const auto& test) {
    return std::all_of(rows.begin(), rows.end(), [&](const Row& row) { return test(row[last - 1]); });
  };
  if (before == '.' || before == ',')
    return all([&](const DigitRun& run) { return run.before == before && run.digits.size() <= 9; });
  return (before == '_' || before == '-') && seconds_differ && (size == 3 || size == 6 || size == 9) &&
         all([&](const DigitRun& run) { return run.before == before && run.digits.size() == size; });
}

std::vector<Date> datesAt(const std::vector<Row>& rows, std::size_t start, const std::vector<std::size_t>& shape,
                          bool with_fraction) {
  std::vector<Date> dates;
  for (const Row& row : rows) {
    const std::optional<Date> date = dateAt(row, start, shape, with_fraction);
    if (!date) return {};
    dates.push_back(*date);
  }
  return dates;
}

}  // namespace

std::optional<NameDates> datesIn(const std::vector<std::vector<DigitRun>>& rows, std::size_t runs) {
  for (std::size_t start = runs; start-- > 0;) {
    for (const std::vector<std::size_t>& shape : shapes()) {
      if (shape.size() > start + 1) continue;
      std::vector<Date> dates = datesAt(rows, start, shape, false);
      if (dates.empty()) continue;
      const std::size_t last = start + 1 - shape.size();
      const bool seconds_differ = std::any_of(dates.begin(), dates.end(),
                                              [&](const Date& date) { return date.seconds != dates.front().seconds; });
      const bool with_fraction = shape.back() != 9 && shape.back() != 17 && hasFraction(rows, last, seconds_differ);
      if (with_fraction) dates = datesAt(rows, start, shape, true);
      NameDates found;
      found.first = with_fraction ? last - 1 : last;
      found.runs = start + 1 - found.first;
      for (const Date& date : dates)
        found.times.push_back(*parseDecimal(std::to_string(date.seconds) + "." + date.fraction));
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace gaussmap::detail
