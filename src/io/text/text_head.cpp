// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/text_head.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

// No row of a point cloud needs this much. The limits bound the memory for the words of one line.
constexpr std::size_t kLongestRow = std::size_t{1} << 16;
constexpr std::size_t kMostColumns = 1000;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns the first word with a decimal comma or with a blank between digits, which is what remains of "1,5 2,5" if a
/// comma separates the columns. Returns an empty word if there is none.
std::string_view decimalComma(const std::vector<std::string_view>& words, char separator) {
  for (const std::string_view word : words)
    for (std::size_t i = 1; i + 1 < word.size(); ++i)
      if (isDigit(word[i - 1]) && (separator == ',' ? isBlank(word[i]) : word[i] == ',')) return word;
  return "";
}

/// Returns true if a header has columns of latitude and longitude.
bool namesDegrees(const std::vector<std::string_view>& words) {
  bool has_latitude = false, has_longitude = false;
  for (const std::string_view word : words) {
    const std::string lower = lowerCase(word);
    has_latitude = has_latitude || lower == "lat" || lower == "latitude";
    has_longitude = has_longitude || lower == "lon" || lower == "lng" || lower == "long" || lower == "longitude";
  }
  return has_latitude && has_longitude;
}

class HeadReader {
 public:
  HeadReader(const std::filesystem::path& path, std::string_view text, const std::vector<PointField>& fields)
      : rows_(path, text.data() + text.size(), ' ', 0), text_(text), fields_(fields), place_{text.data(), 1} {}

  TextHead read() {
    while (nextLine()) {
      const std::string_view line = lineAt(place_.at);
      if (startsComment(line.data(), line.data() + line.size())) {
        takeNames(line);
      } else if (takeRow(line)) {
        break;
      }
      rows_.skipLine(place_);
    }
    if (!head_.has_row) finishWithoutRows();
    return std::move(head_);
  }

 private:
  bool nextLine() {
    const char* const end = text_.data() + text_.size();
    while (place_.at != end && (isBlank(*place_.at) || *place_.at == '\n')) place_.line += *place_.at++ == '\n';
    return place_.at != end;
  }

  std::string_view lineAt(const char* at) const {
    std::string_view rest = text_.substr(static_cast<std::size_t>(at - text_.data()));
    return takeLine(rest);
  }

  bool takeNames(std::string_view line) {
    if (line.size() > kLongestRow) return false;
    std::vector<std::string_view> names = namesOf(line);
    if (names.size() > kMostColumns || !namesCoordinates(names)) return false;
    head_.names = std::move(names);
    head_.names_line = place_.line;
    named_in_row_ = !startsComment(line.data(), line.data() + line.size());
    return true;
  }

  /// Returns true if the line is the first row.
  bool takeRow(std::string_view line) {
    if (line.size() > kLongestRow)
      rows_.fail(place_.line, "is longer than 64 KiB" + std::string(line.find('\r') < line.size()
                                                                        ? ": line ends must be LF or CR LF, not CR only"
                                                                        : ": is this a point cloud?"));
    const char separator = separatorOf(line);
    const std::vector<std::string_view> words = splitRow(line, separator);
    const auto text = std::find_if(words.begin(), words.end(), [](std::string_view word) {
      double ignored = 0.0;
      return !parseCell(word, ignored);
    });
    if (text == words.end()) return words.size() == 1 ? takeCount(words.front()) : startRows(line, separator, words);
    if (!named_in_row_ && !head_.counted && takeNames(line)) return false;
    if (!fields_.empty()) {
      if (hasCoordinates(words)) return startRows(line, separator, words);
      if (!skipped_) return skipped_ = true, false;  // a header that the fields replace
    }
    if (const std::string_view word = decimalComma(words, separator); !word.empty())
      rows_.fail(place_.line, quote(word) + " has a decimal comma: write decimals with a point (1.5, not 1,5)");
    if (head_.names.empty() && namesDegrees(words))
      rows_.fail(place_.line,
                 "names latitude and longitude in degrees, but a map needs metres: convert the file to "
                 "a projected coordinate system, for example UTM");
    if (head_.names.empty() || words.size() < 2)
      rows_.fail(place_.line, notANumber(*text) + ", and the line does not name columns x, y and z" +
                                  (fields_.empty() ? "; name the columns with --fields \"x y z intensity\"" : ""));
    return startRows(line, separator, words);
  }

  bool takeCount(std::string_view word) {
    double value = 0.0;
    parseCell(word, value);
    if (!(value >= 0.0) || value != std::floor(value)) rows_.fail(place_.line, "one column instead of x, y and z");
    if (head_.counted)
      rows_.fail(place_.line, "a second line with one number: expected the points that line " +
                                  std::to_string(head_.body.line) + " counts");
    head_.counted = true;
    head_.body = place_;
    return false;
  }

  bool hasCoordinates(const std::vector<std::string_view>& words) const {
    double ignored = 0.0;
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (const std::string& name = fields_[i].name; name == "x" || name == "y" || name == "z")
        if (i >= words.size() || !parseCell(words[i], ignored)) return false;
    return true;
  }

  bool startRows(std::string_view line, char separator, std::vector<std::string_view> words) {
    // Tabs separate the columns strictly if that is how the header must be read, for example with empty columns.
    const std::size_t names = fields_.empty() ? head_.names.size() : fields_.size();
    if (separator == ' ' && names != 0 && words.size() != names && line.find('\t') < line.size()) {
      std::vector<std::string_view> strict = splitRow(line, '\t');
      if (strict.size() == names) {
        separator = '\t';
        words = std::move(strict);
      }
    }
    head_.columns = words.size();
    while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    // In the first row, the last column can be empty.
    if (separator != ' ' && head_.columns + 1 == names && !line.empty() && line.back() == separator) ++head_.columns;
    if (head_.columns > kMostColumns) rows_.fail(place_.line, "more than 1000 columns: is this a point cloud?");
    head_.separator = separator;
    head_.has_row = true;
    head_.row_line = place_.line;
    if (!head_.counted) head_.body = place_;
    return true;
  }

  void finishWithoutRows() {
    if (head_.names.empty() && !head_.counted)
      rows_.fail(place_.line, "the file has no row of numbers: expected x y z in each line");
    if (!head_.counted) head_.body = place_;
    head_.columns = !fields_.empty() ? fields_.size() : !head_.names.empty() ? head_.names.size() : 3;
    head_.row_line = place_.line;
  }

  RowParser rows_;
  std::string_view text_;
  const std::vector<PointField>& fields_;
  TextPlace place_;
  TextHead head_;
  bool named_in_row_ = false;  // the header is not a comment
  bool skipped_ = false;
};

}  // namespace

std::vector<std::string_view> namesOf(std::string_view line) {
  while (!line.empty() && (isBlank(line.front()) || line.front() == '#' || line.front() == '/' || line.front() == '%'))
    line.remove_prefix(1);
  if (const char separator = separatorOf(line); separator != ' ') return splitRow(line, separator);
  if (line.find('\t') < line.size()) {
    std::vector<std::string_view> names = splitRow(line, '\t');
    if (namesCoordinates(names)) return names;
  }
  std::vector<std::string_view> names;
  for (const std::string_view word : splitRow(line, ' '))
    if (!names.empty() && (word.front() == '[' || word.front() == '(')) {  // a unit
      const char* const first = names.back().data();
      names.back() = {first, static_cast<std::size_t>(word.data() + word.size() - first)};
    } else {
      names.push_back(word);
    }
  return names;
}

TextHead readTextHead(const std::filesystem::path& path, std::string_view text, const std::vector<PointField>& fields) {
  return HeadReader(path, text, fields).read();
}

}  // namespace gaussmap::detail
