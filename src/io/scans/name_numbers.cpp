// SPDX-License-Identifier: BSD-3-Clause
#include "io/scans/name_numbers.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>

namespace gaussmap::detail {
namespace {

constexpr std::uint64_t kMaxIndex = 100000000;  // larger numbers are times
constexpr std::size_t kMaxRuns = 16;            // of digits in a name

/// A run of digits in a name.
struct DigitRun {
  std::string_view digits;
  char before = 0;  ///< the character between this run and the one before it; 0 if there is not exactly one
};

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
  if (absolute != today || (!absolute && between != '.')) return {};
  const Fraction fraction = absolute ? fractionOf(names, run, between) : Fraction::Decimal;
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

/// Returns the numbers of a run if all of them are times of today.
std::vector<Decimal> wholeTimes(const NameTable& names, std::size_t run) {
  std::vector<Decimal> times;
  for (const auto& row : names.rows()) {
    const std::optional<Decimal> time = parseDecimal(row[run].digits);
    if (!time || !isTimeOfDay(time->value())) return {};
    times.push_back(*time);
  }
  return names.varies(run) ? times : std::vector<Decimal>();
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
    if (point == std::string::npos || point == 0) break;
    const auto isLetter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    if (std::none_of(stem.begin() + static_cast<std::ptrdiff_t>(point), stem.end(), isLetter)) break;
    stem.resize(point);
  }
  return stem;
}

NameNumbers numbersIn(const std::vector<std::string>& names) {
  const NameTable table(names);
  NameNumbers numbers;
  std::size_t first_taken = 0, taken = 0;
  const auto take = [&](std::vector<Decimal> times, std::size_t first, std::size_t count) {
    if (times.empty() || !numbers.times.empty()) return;
    numbers.times = std::move(times), first_taken = first, taken = count;
  };
  for (std::size_t run = table.runs(); run-- > 0 && numbers.times.empty();) {
    if (run > 0) take(secondsAndFractions(table, run - 1, true), run - 1, 2);
    take(wholeTimes(table, run), run, 1);
  }
  const bool absolute = !numbers.times.empty();
  for (std::size_t run = table.runs(); run-- > 1;) take(secondsAndFractions(table, run - 1, false), run - 1, 2);
  // Seconds since the start of a log look like "1.000007", where 7 may be the number of the scan.
  for (std::size_t run = 0; run < table.runs() && numbers.indices.empty(); ++run)
    if (table.varies(run) && !(absolute && run >= first_taken && run < first_taken + taken))
      numbers.indices = indicesIn(table, run);
  return numbers;
}

}  // namespace gaussmap::detail
