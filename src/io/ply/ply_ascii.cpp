// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply/ply_ascii.h"

#include <charconv>
#include <cstdint>
#include <string>
#include <system_error>

#include "gaussmap/core/error.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

/// Reads the vertices of an ASCII body, which has one element per line.
class PlyAsciiParser {
 public:
  PlyAsciiParser(const std::filesystem::path& path, const PlyHeader& header, std::string_view bytes)
      : path_(path),
        header_(header),
        place_(bytes.data() + header.data_offset),
        end_(bytes.data() + bytes.size()),
        line_(header.data_line) {}

  std::vector<std::vector<double>> parse(std::size_t vertex, const std::vector<std::size_t>& properties) {
    for (std::size_t i = 0; i < vertex; ++i) skip(header_.elements[i]);
    const PlyElement& element = header_.elements[vertex];
    std::vector<std::vector<double>> columns(properties.size(), std::vector<double>(element.count));
    for (std::size_t i = 0; i < element.count; ++i) {
      begin(element, i);
      parseLine(element, i, properties, columns);
    }
    if (vertex + 1 == header_.elements.size() && skipBlankLines())
      fail("more data than the " + std::to_string(element.count) + " vertices of the header: correct their number");
    return columns;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(path_, "line " + std::to_string(line_) + ": " + what);
  }

  // Returns false at the end of the file.
  bool skipBlankLines() {
    while (place_ != end_ && (isBlank(*place_) || *place_ == '\n')) line_ += *place_++ == '\n';
    return place_ != end_;
  }

  void begin(const PlyElement& element, std::size_t i) {
    if (!skipBlankLines())
      throw FileError(path_, "the data end after " + std::to_string(i) + " of " + std::to_string(element.count) +
                                 " elements " + quote(element.name));
  }

  void skip(const PlyElement& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
      begin(element, i);
      while (place_ != end_ && *place_ != '\n') ++place_;
    }
  }

  void parseLine(const PlyElement& element, std::size_t i, const std::vector<std::size_t>& properties,
                 std::vector<std::vector<double>>& columns) {
    std::size_t wanted = 0;
    for (std::size_t property = 0; property < element.properties.size(); ++property) {
      beginWord(property, element);
      if (wanted < properties.size() && properties[wanted] == property) {
        columns[wanted++][i] = number(element.properties[property].type == NumberType::Float32);
      } else if (element.properties[property].is_list) {
        for (std::uint64_t entries = length(); entries > 0; --entries) {
          beginWord(property, element);
          skipWord();
        }
      } else {
        skipWord();
      }
    }
    skipBlanks();
    if (!atLineEnd())
      fail("more values than the " + std::to_string(element.properties.size()) + " properties of a vertex");
  }

  bool atLineEnd() const { return place_ == end_ || *place_ == '\n'; }
  bool atWordEnd() const { return atLineEnd() || isBlank(*place_); }
  void skipBlanks() {
    while (place_ != end_ && isBlank(*place_)) ++place_;
  }
  void skipWord() {
    while (!atWordEnd()) ++place_;
  }
  void beginWord(std::size_t property, const PlyElement& element) {
    skipBlanks();
    if (atLineEnd()) fail("ends before " + quote(element.properties[property].name));
  }

  double number(bool is_float) {
    double value = 0.0;
    float narrow = 0.0f;
    std::from_chars_result result{};
    if (is_float) result = readNumber(place_, end_, narrow);
    const bool is_narrow = is_float && result.ec == std::errc();
    if (is_narrow)
      value = double{narrow};
    else  // also a float like 1e-300, which is too small or too large
      result = readNumber(place_, end_, value);
    const char* const first = place_;
    place_ = result.ptr;
    if (result.ec == std::errc() && atWordEnd()) return value;
    place_ = first;
    skipWord();
    fail(quote({first, static_cast<std::size_t>(place_ - first)}) + " is not a number (1.5, not 1,5)");
  }

  std::uint64_t length() {
    std::uint64_t entries = 0;
    const char* const first = place_;
    skipWord();
    const auto [end, error] = std::from_chars(first, place_, entries);
    if (error != std::errc() || end != place_)
      fail(quote({first, static_cast<std::size_t>(place_ - first)}) + " is not the length of a list");
    return entries;
  }

  const std::filesystem::path& path_;
  const PlyHeader& header_;
  const char* place_;
  const char* end_;
  std::size_t line_;
};

}  // namespace

std::vector<std::vector<double>> parsePlyAscii(const std::filesystem::path& path, const PlyHeader& header,
                                               std::string_view bytes, std::size_t vertex,
                                               const std::vector<std::size_t>& properties) {
  return PlyAsciiParser(path, header, bytes).parse(vertex, properties);
}

}  // namespace gaussmap::detail
