// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/name_numbers.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>

#include "io/scans/name_dates.h"

namespace gaussmap::detail {
namespace {

constexpr std::uint64_t kMaxIndex = 100000000;  // larger numbers are times
constexpr std::size_t kMaxRuns = 16;            // of digits in a name

bool isNameDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns the runs of digits from the end of the name to its start.
std::vector<DigitRun> runsFromEnd(std::string_view name) {
  std::vector<DigitRun> runs;
  std::size_t end_of_last = std::string_view::npos;
  for (std::size_t i = 0; i < name.size();) {
    if (!isNameDigit(name[i])) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < name.size() && isNameDigit(name[end])) ++end;
    runs.push_back({name.substr(i, end - i), end_of_last + 1 == i && i > 0 ? name[i - 1] : char(0)});
    end_of_last = end;
    i = end;
  }
  std::reverse(runs.begin(), runs.end());
  if (runs.size() > kMaxRuns) runs.resize(kMaxRuns);
  return runs;
}

/// The runs of digits of all names. Run 0 is the last one of each name.
class NameTable {
 public:
  explicit NameTable(const std::vector<std::string>& names) {
    for (const std::string& name : names) stems_.push_back(withoutEndings(name));
    runs_ = kMaxRuns;
    for (const std::string& stem : stems_) {
      rows_.push_back(runsFromEnd(stem));
      runs_ = std::min(runs_, rows_.back().size());
    }
    if (rows_.empty()) runs_ = 0;
  }

  std::size_t runs() const { return runs_; }
  const std::vector<std::vector<DigitRun>>& rows() const { return rows_; }

  /// Returns true if the run differs between the names, or if there is only one name.
  bool varies(std::size_t run) const {
    return rows_.size() == 1 || std::any_of(rows_.begin(), rows_.end(), [&](const std::vector<DigitRun>& row) {
             return row[run].digits != rows_.front()[run].digits;
           });
  }
  template <typename Test>
  bool all(const Test& test) const {
    return std::all_of(rows_.begin(), rows_.end(), test);
  }

 private:
  std::vector<std::string> stems_;
  std::vector<std::vector<DigitRun>> rows_;
  std::size_t runs_ = 0;
};

/// How the digits behind the seconds are to be read.
enum class Fraction { Decimal, Nanoseconds };

/// Writers of `sec.nsec` that do not pad the nanoseconds give them 1 to 9 digits, without a leading zero. A fraction
/// with 3, 6 or 9 digits in all names, or with a leading zero, is a decimal.
Fraction fractionOf(const NameTable& names, std::size_t run, char between) {
  std::size_t shortest = 99, longest = 0;
  bool leading_zero = false;
  for (const auto& row : names.rows()) {
    const std::string_view digits = row[run].digits;
    shortest = std::min(shortest, digits.size());
    longest = std::max(longest, digits.size());
    leading_zero = leading_zero || (digits.size() > 1 && digits.front() == '0');
  }
  if (leading_zero || longest > 9) return Fraction::Decimal;
  if (shortest == longest && (between == '.' || longest % 3 == 0)) return Fraction::Decimal;
  // A double has at most 7 decimals of today's seconds, so more of them, in changing number, are nanoseconds.
  return between == '.' && longest < 8 ? Fraction::Decimal : Fraction::Nanoseconds;
}

/// Returns the numbers of a run; empty if one of them is not a time of today.
std::vector<Decimal> timesOfToday(const NameTable& names, std::size_t run) {
  std::vector<Decimal> times;
  for (const auto& row : names.rows()) {
    const std::optional<Decimal> time = parseDecimal(row[run].digits);
    if (!time || !isTimeOfDay(time->value())) return {};
    times.push_back(*time);
  }
  return times;
}

/// Returns true if the digits behind a decimal point are a time of their own, as in "v2.1700000000.pcd": all have as
/// many digits as a time of today, and they differ by less than a year. Fractions differ by more.
bool isTimeBehindPoint(const NameTable& names, std::size_t run) {
  const std::size_t size = names.rows().front()[run].digits.size();
  if (size != 10 && size != 13 && size != 16 && size != 19) return false;
  if (!names.all([&](const auto& row) { return row[run].digits.size() == size; })) return false;
  const std::vector<Decimal> times = timesOfToday(names, run);
  if (times.empty()) return false;
  const auto [low, high] = std::minmax_element(times.begin(), times.end(),
                                               [](const Decimal& a, const Decimal& b) { return a.digits < b.digits; });
  return high->value() - low->value() < 0.02 * high->value();
}

/// Returns true if the runs are seconds since a start and nanoseconds, as in "12_300000000.pcd". Numbers of scans have
/// leading zeros or fewer digits.
bool isSmallSecondsAndNanoseconds(const NameTable& names, std::size_t run) {
  std::size_t longest = 0;
  const bool fits = names.all([&](const std::vector<DigitRun>& row) {
    const std::string_view seconds = row[run + 1].digits, rest = row[run].digits;
    longest = std::max(longest, rest.size());
    const bool is_number = seconds.size() < 9 && (seconds.size() == 1 || seconds.front() != '0');
    return is_number && (rest.size() == 9 || (rest.size() < 9 && (rest.size() == 1 || rest.front() != '0')));
  });
  return fits && longest == 9;
}

/// Returns the seconds and fractions in the runs `run` + 1 and `run`; empty if a name does not have them. `today`: only
/// times of today, else only others.
std::vector<Decimal> secondsAndFractions(const NameTable& names, std::size_t run, bool today) {
  const char between = names.rows().front()[run].before;
  if (between != '.' && between != '_' && between != ',' && between != '-') return {};
  if (!names.all([&](const auto& row) { return row[run].before == between; })) return {};
  if (!names.varies(run) && !names.varies(run + 1)) return {};
  const auto isAbsolute = [&](const std::vector<DigitRun>& row) {
    const std::optional<Decimal> seconds = parseDecimal(row[run + 1].digits);
    const bool fits =
        between == '.' || (unitByMagnitude(seconds->value()) == TimeUnit::Seconds && row[run].digits.size() <= 9);
    return fits && isTimeOfDay(seconds->value());
  };
  const bool absolute = names.all(isAbsolute);
  if (absolute != today) return {};
  if (!absolute && (between == '.' ? isTimeBehindPoint(names, run) : !isSmallSecondsAndNanoseconds(names, run)))
    return {};
  const Fraction fraction = absolute         ? fractionOf(names, run, between)
                            : between == '.' ? Fraction::Decimal
                                             : Fraction::Nanoseconds;
  std::vector<Decimal> times;
  for (const auto& row : names.rows()) {
    std::string text(row[run].digits);
    if (fraction == Fraction::Nanoseconds) text.insert(0, 9 - text.size(), '0');
    const std::optional<Decimal> time = parseDecimal(std::string(row[run + 1].digits) + "." + text);
    if (!time) return {};
    times.push_back(*time);
  }
  return times;
}

/// Returns the numbers of a run if all of them are times of today, and not the fractions of other numbers.
std::vector<Decimal> wholeTimes(const NameTable& names, std::size_t run) {
  if (run + 1 < names.runs() && !secondsAndFractions(names, run, false).empty()) return {};
  return names.varies(run) ? timesOfToday(names, run) : std::vector<Decimal>();
}

std::vector<std::uint64_t> indicesIn(const NameTable& names, std::size_t run) {
  std::vector<std::uint64_t> indices;
  std::set<std::uint64_t> seen;
  for (const auto& row : names.rows()) {
    const std::string_view digits = row[run].digits;
    std::uint64_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (error != std::errc() || index >= kMaxIndex || !seen.insert(index).second) return {};
    indices.push_back(index);
  }
  return indices;
}

}  // namespace

std::string withoutEndings(const std::string& name) {
  std::string stem = name;
  for (int endings = 0; endings < 2; ++endings) {
    const std::size_t point = stem.rfind('.');
    if (point == std::string::npos || point == 0 || point + 1 == stem.size()) break;
    // Behind a digit there is a fraction: "1700000000.5_cloud" has no ending.
    const auto first = static_cast<unsigned char>(stem[point + 1]);
    if (std::isalpha(first) == 0 || stem.find('/', point) != std::string::npos) break;
    stem.resize(point);
  }
  return stem;
}

NameNumbers numbersIn(const std::vector<std::string>& names) {
  const NameTable table(names);
  NameNumbers numbers;
  std::size_t first_taken = 0, taken = 0;
  const auto isFree = [&](std::size_t run) { return run < first_taken || run >= first_taken + taken; };
  if (std::optional<NameDates> dates = datesIn(table.rows(), table.runs())) {
    // All names of a log can have the date of its start.
    bool differ = names.size() == 1;
    for (std::size_t run = dates->first; run < dates->first + dates->runs; ++run) differ = differ || table.varies(run);
    if (differ) numbers.times = std::move(dates->times), numbers.dates = true;
    first_taken = dates->first, taken = dates->runs;
  }
  const auto take = [&](std::vector<Decimal> times, std::size_t first, std::size_t count) {
    if (times.empty() || !numbers.times.empty()) return;
    numbers.times = std::move(times), first_taken = first, taken = count;
  };
  const auto takePair = [&](std::size_t run, bool today) {
    if (isFree(run) && isFree(run + 1)) take(secondsAndFractions(table, run, today), run, 2);
  };
  for (std::size_t run = table.runs(); run-- > 0 && numbers.times.empty();) {
    if (run > 0) takePair(run - 1, true);
    if (isFree(run)) take(wholeTimes(table, run), run, 1);
  }
  const std::size_t first_absolute = first_taken, absolute = taken;
  for (std::size_t run = table.runs(); run-- > 1;) takePair(run - 1, false);
  // Seconds since the start of a log look like "1.000007", where 7 may be the number of the scan.
  for (std::size_t run = 0; run < table.runs() && numbers.indices.empty(); ++run)
    if (table.varies(run) && !(run >= first_absolute && run < first_absolute + absolute))
      numbers.indices = indicesIn(table, run);
  return numbers;
}

}  // namespace gaussmap::detail
