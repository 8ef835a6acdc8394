// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/pcd_header.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/files/text.h"
#include "io/files/written_position.h"

namespace gaussmap::detail {
namespace {

enum Keyword { kVersion, kFields, kSize, kType, kCount, kWidth, kHeight, kViewpoint, kPoints, kData, kKeywords };
constexpr std::array<std::string_view, kKeywords> kNames = {"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                                            "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
constexpr std::string_view kOldFields = "COLUMNS";  // the name of FIELDS before version 0.5
// No header needs this much. The limit avoids a search through a large file that is not a PCD file.
constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

struct Line {
  std::size_t number = 0;  // 0: the keyword does not occur
  std::vector<std::string_view> words;
};

class HeaderParser {
 public:
  HeaderParser(const std::filesystem::path& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  PcdHeader parse() {
    refuseOtherFiles();
    collectLines();
    readVersion();
    readFields();
    readSizes();
    readTypes();
    readCounts();
    layOutRecord();
    nameCoordinates();
    requireCoordinates();
    dropEmptyFields();
    readPoints();
    readViewpoint();
    readEncoding();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw FileError(path_, "line " + std::to_string(line) + ": " + what);
  }
  [[noreturn]] void failWithout(Keyword keyword) const {
    throw FileError(path_, "the header has no line " + std::string(kNames[keyword]));
  }
  bool has(Keyword keyword) const { return lines_[keyword].number != 0; }

  void refuseOtherFiles() const {
    if (bytes_.empty()) throw FileError(path_, "the file is empty");
    if (bytes_.substr(0, kByteOrderMark.size()) == kByteOrderMark)
      fail(1, "the file starts with a byte order mark: save the file as UTF-8 without it");
  }

  void collectLines() {
    std::string_view rest = bytes_.substr(0, kLongestHeader);
    for (std::size_t number = 1; !rest.empty(); ++number) {
      const std::string_view line = takeLine(rest);
      std::vector<std::string_view> words = splitWords(line);
      if (words.empty() || words.front().front() == '#') continue;
      const Keyword keyword = keywordOf(words.front(), number);
      if (has(keyword)) fail(number, "a second line " + std::string(kNames[keyword]));
      words.erase(words.begin());
      words.erase(std::find_if(words.begin(), words.end(), [](std::string_view word) { return word.front() == '#'; }),
                  words.end());  // a comment
      lines_[keyword] = {number, std::move(words)};
      if (keyword != kData) continue;
      header_.data_offset = static_cast<std::size_t>(rest.data() - bytes_.data());
      header_.data_line = number + 1;
      return;
    }
    if (bytes_.size() > kLongestHeader) throw FileError(path_, "no DATA line in the first MiB: is this a PCD file?");
    throw FileError(path_, "the file ends inside the header: no DATA line");
  }

  Keyword keywordOf(std::string_view word, std::size_t line) const {
    if (word == kOldFields) return kFields;
    const auto found = std::find(kNames.begin(), kNames.end(), word);
    if (found == kNames.end())
      fail(line, quote(word) + " does not belong in a PCD header (VERSION, FIELDS, SIZE ...): is this a PCD file?");
    return static_cast<Keyword>(found - kNames.begin());
  }

  std::size_t wholeNumber(Keyword keyword, std::string_view word) const {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      fail(lines_[keyword].number, std::string(kNames[keyword]) + " is " + quote(word) + ", not a whole number" +
                                       (error == std::errc::result_out_of_range ? " of 64 bits" : " >= 0"));
    return value;
  }

  std::size_t singleNumber(Keyword keyword) const {
    const Line& line = lines_[keyword];
    if (line.words.size() != 1)
      fail(line.number,
           std::string(kNames[keyword]) + " has " + std::to_string(line.words.size()) + " numbers instead of 1");
    return wholeNumber(keyword, line.words.front());
  }

  void requireOnePerField(Keyword keyword) const {
    const std::size_t entries = lines_[keyword].words.size();
    if (entries != header_.fields.size())
      fail(lines_[keyword].number, std::string(kNames[keyword]) + " has " + std::to_string(entries) + " entries for " +
                                       std::to_string(header_.fields.size()) + " FIELDS");
  }

  void readVersion() const {
    if (!has(kVersion)) return;
    const Line& line = lines_[kVersion];
    std::string_view word = line.words.size() == 1 ? line.words.front() : "";
    if (word.substr(0, 4) == "PCD_") word.remove_prefix(4);
    if (!word.empty() && upper(word.front()) == 'V') word.remove_prefix(1);  // some programs write v0.7 or PCD_V7
    double version = 0.0;
    if (parseNumber(word, version))
      for (const double known : {0.5, 0.6, 0.7, 5.0, 6.0, 7.0})
        if (std::abs(version - known) < 1e-9) return;
    fail(line.number,
         "VERSION is " + quote(line.words.empty() ? "" : line.words.front()) + ", expected 0.5, 0.6 or 0.7");
  }

  void readFields() {
    if (!has(kFields)) failWithout(kFields);
    for (const std::string_view name : lines_[kFields].words) {
      PcdField field;
      field.name = name;
      header_.fields.push_back(std::move(field));
    }
    // Before version 0.6 both lines were optional, and every field was a float.
    if (has(kSize) != has(kType)) failWithout(has(kSize) ? kType : kSize);
  }

  void readSizes() {
    if (!has(kSize)) return;
    requireOnePerField(kSize);
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      header_.fields[i].size = wholeNumber(kSize, lines_[kSize].words[i]);
      if (header_.fields[i].size == 0) fail(lines_[kSize].number, "the SIZE of " + nameOf(i) + " is 0");
    }
  }

  void readTypes() {
    if (!has(kType)) return;
    requireOnePerField(kType);
    for (std::size_t i = 0; i < header_.fields.size(); ++i) {
      const std::string_view word = lines_[kType].words[i];
      char type = upper(word.front());  // PCL reads only the first letter too, for example of float
      if (type == 'B' && header_.fields[i].size == 1) type = 'U';  // PCL's bool
      if (type != 'I' && type != 'U' && type != 'F')
        fail(lines_[kType].number, "the TYPE of " + nameOf(i) + " is " + quote(word) + ", not I, U or F");
      header_.fields[i].type = type;
    }
  }

  void readCounts() {
    if (!has(kCount)) return;
    requireOnePerField(kCount);
    for (std::size_t i = 0; i < header_.fields.size(); ++i)
      header_.fields[i].count = wholeNumber(kCount, lines_[kCount].words[i]);
  }

  std::string nameOf(std::size_t field) const { return "field " + quote(header_.fields[field].name); }

  void layOutRecord() {
    for (PcdField& field : header_.fields) {
      std::size_t bytes = 0;
      field.offset = header_.record_size;
      field.column = header_.columns;
      if (__builtin_mul_overflow(field.size, field.count, &bytes) ||
          __builtin_add_overflow(header_.record_size, bytes, &header_.record_size) ||
          __builtin_add_overflow(header_.columns, field.count, &header_.columns))
        fail(lines_[has(kCount) ? kCount : kSize].number, "the size of a point overflows 64 bits");
    }
  }

  std::size_t fieldsNamed(std::string_view name) const {
    return static_cast<std::size_t>(std::count_if(header_.fields.begin(), header_.fields.end(),
                                                  [&](const PcdField& field) { return field.name == name; }));
  }

  // PDAL writes X Y Z. All other code looks for x y z.
  void nameCoordinates() {
    for (const char* const name : {"x", "y", "z"})
      if (fieldsNamed(name) > 0) return;
    for (PcdField& field : header_.fields)
      if (field.name == "X" || field.name == "Y" || field.name == "Z") field.name = lowerCase(field.name);
  }

  void requireCoordinates() const {
    for (const char* const name : {"x", "y", "z"}) {
      const PcdField* const field = header_.find(name);
      if (!field) fail(lines_[kFields].number, "no field " + quote(name) + ": a map needs x, y and z [m]");
      if (fieldsNamed(name) > 1) fail(lines_[kFields].number, "the field " + quote(name) + " occurs twice");
      const std::string found = std::string(name) + " is TYPE " + field->type + " SIZE " + std::to_string(field->size);
      if (field->type != 'F')
        fail(lines_[kType].number,
             found + ": integer coordinates have no known unit, convert them to metres as F 4 or F 8");
      if (field->size != 4 && field->size != 8)
        fail(lines_[kSize].number, found + ": convert the coordinates to F 4 or F 8");
      if (field->count != 1)
        fail(lines_[kCount].number, std::string(name) + " has COUNT " + std::to_string(field->count) + " instead of 1");
    }
  }

  // A field with COUNT 0 holds nothing. Some programs write such fields as padding.
  void dropEmptyFields() {
    header_.fields.erase(std::remove_if(header_.fields.begin(), header_.fields.end(),
                                        [](const PcdField& field) { return field.count == 0; }),
                         header_.fields.end());
  }

  void readPoints() {
    if (!has(kPoints) && !has(kWidth)) failWithout(kPoints);
    header_.points = has(kPoints) ? singleNumber(kPoints) : 0;
    header_.height = has(kHeight) ? singleNumber(kHeight) : 1;
    header_.width = has(kWidth) ? singleNumber(kWidth) : header_.points;
    std::size_t product = 0;
    if (__builtin_mul_overflow(header_.width, header_.height, &product))
      fail(lines_[kWidth].number, "WIDTH * HEIGHT = " + std::to_string(header_.width) + " * " +
                                      std::to_string(header_.height) + " overflows 64 bits");
    if (!has(kPoints)) header_.points = product;
    if (header_.points != product)
      fail(lines_[kPoints].number, "POINTS is " + std::to_string(header_.points) + ", but WIDTH * HEIGHT = " +
                                       std::to_string(header_.width) + " * " + std::to_string(header_.height));
  }

  void readViewpoint() {
    if (!has(kViewpoint)) return;
    const Line& line = lines_[kViewpoint];
    if (line.words.size() != 7)
      fail(line.number,
           "VIEWPOINT has " + std::to_string(line.words.size()) + " numbers instead of tx ty tz qw qx qy qz");
    std::array<double, 7> v{};
    for (std::size_t i = 0; i < v.size(); ++i)
      if (!parseNumber(line.words[i], v[i]))
        fail(line.number, "VIEWPOINT: " + quote(line.words[i]) + " is not a number");
    header_.viewpoint.translation = {v[0], v[1], v[2]};
    header_.viewpoint.rotation = {v[3], v[4], v[5], v[6]};
    header_.has_viewpoint = true;
    header_.viewpoint_step = stepOfRoundedPosition({line.words[0], line.words[1], line.words[2]});
  }

  void readEncoding() {
    const Line& line = lines_[kData];
    const std::string word = line.words.size() == 1 ? lowerCase(line.words.front()) : "";
    if (word == "ascii") {
      header_.encoding = PcdEncoding::Ascii;
    } else if (word == "binary") {
      header_.encoding = PcdEncoding::Binary;
    } else if (word == "binary_compressed") {
      header_.encoding = PcdEncoding::BinaryCompressed;
    } else {
      fail(line.number, "DATA must be followed by ascii, binary or binary_compressed");
    }
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  std::array<Line, kKeywords> lines_;
  PcdHeader header_;
};

}  // namespace

bool isPcd(std::string_view start) {
  constexpr std::string_view kComment = "# .PCD";
  while (!start.empty()) {
    if (start.substr(0, kComment.size()) == kComment) return true;
    const std::vector<std::string_view> words = splitWords(takeLine(start));
    if (words.empty() || words.front().front() == '#') continue;
    return words.front() == kOldFields || std::find(kNames.begin(), kNames.end(), words.front()) != kNames.end();
  }
  return false;
}

PcdHeader parsePcdHeader(const std::filesystem::path& path, std::string_view bytes) {
  return HeaderParser(path, bytes).parse();
}

}  // namespace gaussmap::detail
