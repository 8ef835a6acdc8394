// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/text_rows.h"

#include <charconv>
#include <cstring>
#include <limits>
#include <system_error>

#include "gaussmap/core/error.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

/// Returns the place behind a quoted word that starts at `at`, or the end of the line. Two quotes inside are one quote.
const char* endOfQuoted(const char* at, const char* end) {
  for (++at; at != end && *at != '\n'; ++at) {
    if (*at != '"') continue;
    if (end - at > 1 && at[1] == '"') {
      ++at;
    } else {
      return at + 1;
    }
  }
  return at;
}

std::string_view withoutQuotes(std::string_view word) {
  while (!word.empty() && isBlank(word.front())) word.remove_prefix(1);
  while (!word.empty() && isBlank(word.back())) word.remove_suffix(1);
  if (word.size() > 1 && word.front() == '"' && word.back() == '"') {
    word = word.substr(1, word.size() - 2);
    while (!word.empty() && isBlank(word.front())) word.remove_prefix(1);
    while (!word.empty() && isBlank(word.back())) word.remove_suffix(1);
  }
  return word;
}

bool equalsIgnoringCase(std::string_view word, std::string_view lower) {
  if (word.size() != lower.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (word[i] != lower[i] && (lower[i] < 'a' || lower[i] > 'z' || word[i] != lower[i] - 'a' + 'A')) return false;
  return true;
}

}  // namespace

char separatorOf(std::string_view row) {
  char separator = ' ';
  const char* const end = row.data() + row.size();
  for (const char* at = row.data(); at != end;) {
    if (*at == '"') {
      at = endOfQuoted(at, end);
      continue;
    }
    if (*at == ';') return ';';
    if (*at == ',') separator = ',';
    ++at;
  }
  return separator;
}

std::vector<std::string_view> splitRow(std::string_view row, char separator) {
  std::vector<std::string_view> words;
  const char* at = row.data();
  const char* const end = at + row.size();
  const auto isSeparator = [separator](char c) { return separator == ' ' ? isBlank(c) : c == separator; };
  while (true) {
    while (at != end && isBlank(*at) && *at != separator) ++at;
    if (separator == ' ')
      while (at != end && isBlank(*at)) ++at;
    if (at == end || startsComment(at, end)) return words;
    const char* const first = at;
    if (*at == '"') at = endOfQuoted(at, end);
    while (at != end && !isSeparator(*at) && !(isBlank(at[0]) && startsComment(at + 1, end))) ++at;
    words.push_back(withoutQuotes({first, static_cast<std::size_t>(at - first)}));
    if (at != end && separator != ' ' && *at == separator) ++at;
  }
}

bool parseCell(std::string_view word, double& value) {
  word = withoutQuotes(word);
  if (detail::parseNumber(word, value)) return true;
  std::string_view digits = word;
  if (!digits.empty() && (digits.front() == '-' || digits.front() == '+')) digits.remove_prefix(1);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const std::string_view missing : {"", "na", "n/a", "null", "none"})
    if (equalsIgnoringCase(word, missing)) return value = kNaN, true;
  for (const std::string_view windows : {"1.#qnan", "1.#snan", "1.#ind"})
    if (equalsIgnoringCase(digits.substr(0, windows.size()), windows)) return value = kNaN, true;
  if (equalsIgnoringCase(digits.substr(0, 6), "1.#inf"))
    return value = word.front() == '-' ? -kInfinity : kInfinity, true;
  return false;
}

std::string notANumber(std::string_view word) {
  std::string what = quote(word) + " is not a number";
  const std::size_t comma = word.find(',');
  double ignored = 0.0;
  if (comma != std::string_view::npos && detail::parseNumber(word.substr(0, comma), ignored))
    return what + ": write decimals with a point (1.5, not 1,5)";
  double value = 0.0;
  const auto [end, error] = readNumber(word.data(), word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range) return quote(word) + " does not fit a double";
  return what;
}

void RowParser::fail(std::size_t line, const std::string& what) const {
  throw FileError(path_, "line " + std::to_string(line) + ": " + what);
}

const char* RowParser::skipBlanks(const char* at) const {
  while (at != end_ && isBlank(*at)) ++at;
  return at;
}

void RowParser::skipLine(TextPlace& place) const {
  const void* const found = std::memchr(place.at, '\n', static_cast<std::size_t>(end_ - place.at));
  if (found == nullptr) {
    place.at = end_;
    return;
  }
  place.at = static_cast<const char*>(found) + 1;
  ++place.line;
}

bool RowParser::findRow(TextPlace& place) const {
  while (true) {
    while (place.at != end_ && (isBlank(*place.at) || *place.at == '\n')) place.line += *place.at++ == '\n';
    if (place.at == end_) return false;
    if (!startsComment(place.at, end_)) return true;
    skipLine(place);
  }
}

const char* RowParser::endOfWord(const char* at) const {
  if (at != end_ && *at == '"') at = endOfQuoted(at, end_);
  if (separator_ == ' ') {
    while (!atLineEnd(at) && !isBlank(*at)) ++at;
  } else {
    while (!atLineEnd(at) && *at != separator_) ++at;
  }
  return at;
}

const char* RowParser::parseNumber(const char* at, std::size_t line, double& value) const {
  const auto [end, error] = readNumber(at, end_, value);
  if (error == std::errc() && (atLineEnd(end) || isBlank(*end) || *end == separator_)) return end;
  const char* const word_end = endOfWord(at);
  const std::string_view word(at, static_cast<std::size_t>(word_end - at));
  if (!parseCell(word, value)) fail(line, notANumber(word));
  return word_end;
}

void RowParser::failAtColumns(const TextPlace& row) const {
  const char* end = row.at;
  while (!atLineEnd(end)) ++end;
  const std::size_t found = splitRow({row.at, static_cast<std::size_t>(end - row.at)}, separator_).size();
  fail(row.line, std::to_string(found) + (found == 1 ? " column" : " columns") + " instead of " +
                     std::to_string(columns_) + " as in the rows before");
}

template <bool kBlanks>
void RowParser::parseAs(TextPlace& place, const std::vector<WantedColumn>& wanted, std::size_t row) const {
  const char* at = place.at;
  const WantedColumn* next = wanted.data();
  const WantedColumn* const last = next + wanted.size();
  for (std::size_t column = 0; column < columns_; ++column) {
    // A separator that is a tab is a blank, too, so it must not be skipped.
    while (at != end_ && isBlank(*at) && (kBlanks || *at != separator_)) ++at;
    if (atLineEnd(at) && (kBlanks || column + 1 < columns_)) failAtColumns(place);
    if (next != last && next->column == column) {
      at = parseNumber(at, place.line, next->values[row]);
      ++next;
    } else {
      at = endOfWord(at);
    }
    if (kBlanks) continue;
    while (at != end_ && isBlank(*at) && *at != separator_) ++at;
    if (at != end_ && *at == separator_) {
      ++at;  // one separator may follow the last column
    } else if (column + 1 < columns_) {
      if (!atLineEnd(at) && !startsComment(at, end_)) {
        const char* const end = endOfWord(at);
        fail(place.line, "no " + quote({&separator_, 1}) + " before " +
                             quote({at, static_cast<std::size_t>(end - at)}) +
                             "; write decimals with a point (1.5, not 1,5)");
      }
      failAtColumns(place);
    }
  }
  at = skipBlanks(at);
  if (startsComment(at, end_))
    while (!atLineEnd(at)) ++at;
  if (!atLineEnd(at)) failAtColumns(place);
  place.at = at;
  if (at == end_) return;
  ++place.at;
  ++place.line;
}

void RowParser::parse(TextPlace& place, const std::vector<WantedColumn>& wanted, std::size_t row) const {
  if (separator_ == ' ') {
    parseAs<true>(place, wanted, row);
  } else {
    parseAs<false>(place, wanted, row);
  }
}

void RowParser::parseRows(TextPlace place, std::size_t skip, std::size_t count,
                          const std::vector<WantedColumn>& wanted) const {
  const auto requireRow = [&] {
    if (!findRow(place)) fail(place.line, "the text ends too early");
  };
  for (std::size_t i = 0; i < skip; ++i) {
    requireRow();
    skipLine(place);
  }
  for (std::size_t i = 0; i < count; ++i) {
    requireRow();
    parse(place, wanted, i);
  }
}

}  // namespace gaussmap::detail
