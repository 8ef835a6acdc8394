// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "io/files/text.h"
#include "io/pcd/pcd_body.h"

namespace gaussmap::detail {
namespace {

class AsciiParser {
 public:
  AsciiParser(const std::filesystem::path& path, const PcdHeader& header, std::string_view data)
      : path_(path), header_(header), place_(data.data()), end_(place_ + data.size()), line_(header.data_line) {}

  void parse(std::vector<AsciiColumn>& columns) {
    for (AsciiColumn& column : columns)
      if (isInteger(column.kind))
        column.integers.resize(header_.points);
      else
        column.values.resize(header_.points);
    for (std::size_t point = 0; point < header_.points; ++point) {
      if (!skipBlankLines())
        throw FileError(
            path_, "the data end after " + std::to_string(point) + " of " + std::to_string(header_.points) + " points");
      parseLine(point, columns);
    }
    if (skipBlankLines())
      fail("more data than the " + std::to_string(header_.points) + " points of the header: correct POINTS and WIDTH");
  }

 private:
  static bool isInteger(AsciiKind kind) { return kind == AsciiKind::Signed || kind == AsciiKind::Unsigned; }

  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(path_, "line " + std::to_string(line_) + ": " + what);
  }

  // Skips blank lines and comments. Returns false at the end of the file.
  bool skipBlankLines() {
    while (true) {
      while (place_ != end_ && (isBlank(*place_) || *place_ == '\n')) line_ += *place_++ == '\n';
      if (place_ == end_ || *place_ != '#') return place_ != end_;
      while (!atLineEnd()) ++place_;
    }
  }

  void skipBlanks() {
    while (place_ != end_ && isBlank(*place_)) ++place_;
  }
  bool atLineEnd() const { return place_ == end_ || *place_ == '\n'; }
  bool atWordEnd() const { return place_ == end_ || isBlank(*place_) || *place_ == '\n'; }

  void parseLine(std::size_t point, std::vector<AsciiColumn>& columns) {
    auto wanted = columns.begin();
    for (std::size_t column = 0; column < header_.columns; ++column) {
      skipBlanks();
      if (atLineEnd()) fail(std::to_string(column) + " columns instead of " + std::to_string(header_.columns));
      if (wanted != columns.end() && wanted->column == column) {
        const char* const word = place_;
        for (; wanted != columns.end() && wanted->column == column; ++wanted) {
          place_ = word;
          if (isInteger(wanted->kind))
            wanted->integers[point] = parseInteger(wanted->kind);
          else
            wanted->values[point] = parseWord(wanted->kind == AsciiKind::Single);
        }
      } else {
        while (!atWordEnd()) ++place_;
      }
    }
    skipBlanks();
    if (!atLineEnd()) fail("more than " + std::to_string(header_.columns) + " columns");
  }

  std::uint64_t parseInteger(AsciiKind kind) {
    std::int64_t number = 0;
    std::uint64_t positive = 0;
    const bool is_signed = kind == AsciiKind::Signed;
    const char* const first = end_ - place_ > 1 && *place_ == '+' && place_[1] != '-' ? place_ + 1 : place_;
    const std::from_chars_result result =
        is_signed ? std::from_chars(first, end_, number) : std::from_chars(first, end_, positive);
    if (result.ec == std::errc() && (result.ptr == end_ || isBlank(*result.ptr) || *result.ptr == '\n')) {
      place_ = result.ptr;
      return is_signed ? static_cast<std::uint64_t>(number) : positive;
    }
    // Some programs write integers like 1.6e9, 3.0 or nan.
    const double value = parseWord(false);
    return is_signed ? static_cast<std::uint64_t>(nearestOf<std::int64_t>(value)) : nearestOf<std::uint64_t>(value);
  }

  double parseWord(bool single) {
    double value = 0.0;
    float narrow = 0.0f;
    std::from_chars_result result{};
    if (single) result = readNumber(place_, end_, narrow);
    const bool is_narrow = single && result.ec != std::errc::result_out_of_range;
    // Some programs write doubles like 1e-300 although the header declares floats.
    if (!is_narrow) result = readNumber(place_, end_, value);
    const bool overflows = single && !is_narrow && std::abs(value) > double{std::numeric_limits<float>::max()};
    if (overflows || result.ec == std::errc::result_out_of_range)
      failAtWord("does not fit the type of the field (F 4 or F 8)");
    const bool ends_word = result.ptr == end_ || isBlank(*result.ptr) || *result.ptr == '\n';
    if (result.ec != std::errc() || !ends_word)
      failAtWord("is not a number (1.5, not 1,5; blanks between the columns)");
    place_ = result.ptr;
    return is_narrow ? double{narrow} : single ? double{static_cast<float>(value)} : value;
  }

  [[noreturn]] void failAtWord(const std::string& what) const {
    const char* word_end = place_;
    while (word_end != end_ && !isBlank(*word_end) && *word_end != '\n') ++word_end;
    fail(quote({place_, static_cast<std::size_t>(word_end - place_)}) + " " + what);
  }

  const std::filesystem::path& path_;
  const PcdHeader& header_;
  const char* place_;
  const char* end_;
  std::size_t line_;
};

}  // namespace

void parsePcdAscii(const std::filesystem::path& path, const PcdHeader& header, std::string_view data,
                   std::vector<AsciiColumn>& columns) {
  AsciiParser(path, header, data).parse(columns);
}

}  // namespace gaussmap::detail
