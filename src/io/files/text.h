// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

// Text as scans and poses bring it: lines, words, numbers. Never asks the locale.
namespace gaussmap::detail {

/// A carriage return counts as a blank, so that files from Windows read like others.
inline bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Takes the first line off `rest`, without its line end.
std::string_view takeLine(std::string_view& rest);

/// The words of a line.
std::vector<std::string_view> splitWords(std::string_view line);

/// A piece of a file as it may be shown in a message: short, in quotes, unprintable bytes as \xNN.
std::string quote(std::string_view piece);

/// Reads a number at the start of [first, last): decimal, exponent, nan, inf, a leading + too. The value is
/// untouched unless the error code is zero; the pointer is behind the number.
template <typename Real>
std::from_chars_result readNumber(const char* first, const char* last, Real& value) {
  if (last - first > 1 && *first == '+' && first[1] != '-') ++first;
  return std::from_chars(first, last, value);
}

/// True if the whole word is a number; then it is in `value`.
inline bool parseNumber(std::string_view word, double& value) {
  const char* const last = word.data() + word.size();
  const auto [end, error] = readNumber(word.data(), last, value);
  return error == std::errc() && end == last;
}

}  // namespace gaussmap::detail
