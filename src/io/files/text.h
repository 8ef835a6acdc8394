// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>
#include "gaussmap/version.h"

// Lines, words and numbers of text files. The functions do not depend on the locale.
namespace gaussmap::detail {

/// Returns true for a blank. A carriage return is a blank, so that files from Windows can be read.
inline bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Returns the text with ASCII capitals as small letters.
GAUSSMAP_API std::string lowerCase(std::string_view text);
/// Returns the text without blanks and line ends at both ends.
std::string_view trimmed(std::string_view text);
/// Returns true if the text ends with `end`.
inline bool endsWith(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

/// Removes the first line from `rest` and returns it without its line end.
GAUSSMAP_API std::string_view takeLine(std::string_view& rest);

/// Returns the words of a line.
GAUSSMAP_API std::vector<std::string_view> splitWords(std::string_view line);

/// Returns a piece of a file for a message: in quotes, at most 40 characters, unprintable bytes as \xNN.
GAUSSMAP_API std::string quote(std::string_view piece);

/// Reads a number at the start of [first, last): decimal, with an exponent, nan, inf; a leading + is allowed. The value
/// is changed only if the error code of the result is zero. The pointer of the result is behind the number.
template <typename Real>
std::from_chars_result readNumber(const char* first, const char* last, Real& value) {
  if (last - first > 1 && *first == '+' && first[1] != '-') ++first;
  return std::from_chars(first, last, value);
}

/// Returns true if the whole word is a number, and stores it in `value`.
inline bool parseNumber(std::string_view word, double& value) {
  const char* const last = word.data() + word.size();
  const auto [end, error] = readNumber(word.data(), last, value);
  return error == std::errc() && end == last;
}

}  // namespace gaussmap::detail
