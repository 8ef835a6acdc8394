// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

// Rows of numbers in a text: separators, comments, quoted words. A row is a line that is not blank and not a comment.
namespace gaussmap::detail {

/// Returns true if a line without leading blanks is a comment: it starts with #, // or %.
inline bool startsComment(const char* place, const char* end) {
  return place != end && (*place == '#' || *place == '%' || (*place == '/' && end - place > 1 && place[1] == '/'));
}

/// Returns the separator of the columns of a row: ',' or ';', or ' ' if blanks and tabs separate them.
char separatorOf(std::string_view row);

/// Returns the columns of a row, without blanks and quotes around them. A comment at the end of the row and an empty
/// column after the last separator are left out. `separator` is ' ' (blanks and tabs), '\t', ',' or ';'.
std::vector<std::string_view> splitRow(std::string_view row, char separator);

/// Parses a number: also nan and inf in upper or lower case, and "1.#QNAN" of Windows. An empty word, NA,
/// null and none mean NaN. Returns false if the word is not a number.
bool parseCell(std::string_view word, double& value);

/// Returns why a word is not a number, for a message: "'1,5' is not a number (1.5, not 1,5)".
std::string notANumber(std::string_view word);

/// A position in a text.
struct TextPlace {
  const char* at = nullptr;
  std::size_t line = 1;  ///< from 1
};

/// A column to read.
struct WantedColumn {
  std::size_t column = 0;
  double* values = nullptr;  ///< one number per row
};

/// Reads rows that all have the same number of columns.
class RowParser {
 public:
  /// `end` is the end of the text. `path` must live as long as this object.
  RowParser(const std::filesystem::path& path, const char* end, char separator, std::size_t columns)
      : path_(path), end_(end), separator_(separator), columns_(columns) {}

  /// Moves to the first character of the next row that is not blank. Returns false at the end of the text.
  bool findRow(TextPlace& place) const;
  /// Moves behind the end of the line.
  void skipLine(TextPlace& place) const;
  /// Reads the row at `place`, which findRow() has found, into values[row] of the wanted columns, and moves behind the
  /// end of the line. The wanted columns must be in ascending order. Throws FileError if the row has another number of
  /// columns, or if a wanted column is not a number.
  void parse(TextPlace& place, const std::vector<WantedColumn>& wanted, std::size_t row) const;
  /// Skips rows and then reads rows. Throws FileError if the text ends before.
  void parseRows(TextPlace place, std::size_t skip, std::size_t count, const std::vector<WantedColumn>& wanted) const;

  /// Throws a FileError with the number of the line.
  [[noreturn]] void fail(std::size_t line, const std::string& what) const;

 private:
  bool atLineEnd(const char* at) const { return at == end_ || *at == '\n'; }
  const char* skipBlanks(const char* at) const;
  const char* endOfWord(const char* at) const;
  const char* parseNumber(const char* at, std::size_t line, double& value) const;
  [[noreturn]] void failAtColumns(const TextPlace& row) const;
  template <bool kBlanks>
  void parseAs(TextPlace& place, const std::vector<WantedColumn>& wanted, std::size_t row) const;

  const std::filesystem::path& path_;
  const char* end_;
  char separator_;
  std::size_t columns_;
};

}  // namespace gaussmap::detail
