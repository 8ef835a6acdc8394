// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply/ply_header.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "gaussmap/core/error.h"
#include "io/files/mapped_file.h"
#include "io/files/text.h"

namespace gaussmap::detail {
namespace {

// No header needs this much. The limit avoids a search through a large file that is not a PLY file.
constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

constexpr std::array<std::pair<std::string_view, NumberType>, 16> kTypes = {{{"char", NumberType::Int8},
                                                                             {"int8", NumberType::Int8},
                                                                             {"uchar", NumberType::UInt8},
                                                                             {"uint8", NumberType::UInt8},
                                                                             {"short", NumberType::Int16},
                                                                             {"int16", NumberType::Int16},
                                                                             {"ushort", NumberType::UInt16},
                                                                             {"uint16", NumberType::UInt16},
                                                                             {"int", NumberType::Int32},
                                                                             {"int32", NumberType::Int32},
                                                                             {"uint", NumberType::UInt32},
                                                                             {"uint32", NumberType::UInt32},
                                                                             {"float", NumberType::Float32},
                                                                             {"float32", NumberType::Float32},
                                                                             {"double", NumberType::Float64},
                                                                             {"float64", NumberType::Float64}}};

class HeaderParser {
 public:
  HeaderParser(const std::filesystem::path& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  PlyHeader parse() {
    if (bytes_.empty()) throw FileError(path_, "the file is empty");
    std::string_view rest = bytes_.substr(0, kLongestHeader);
    for (line_ = 1; !rest.empty(); ++line_) {
      const bool is_whole_line = rest.find('\n') != std::string_view::npos;
      const std::vector<std::string_view> words = splitWords(takeLine(rest));
      if (line_ == 1) {
        if (words.size() != 1 || words.front() != "ply")
          fail("begins with " + quote(words.empty() ? "" : words.front()) +
               " instead of a line 'ply': is this a PLY file?");
        continue;
      }
      if (words.empty() || words.front() == "comment" || words.front() == "obj_info") continue;
      if (words.front() != "end_header") {
        take(words);
        continue;
      }
      if (!has_format_) fail("no line 'format' before end_header");
      if (!is_whole_line && header_.encoding != PlyEncoding::Ascii) fail("no line end after end_header");
      header_.data_offset = static_cast<std::size_t>(rest.data() - bytes_.data());
      header_.data_line = line_ + 1;
      return std::move(header_);
    }
    if (bytes_.size() > kLongestHeader) throw FileError(path_, "no end_header in the first MiB: is this a PLY file?");
    throw FileError(path_, "the file ends inside the header: no end_header");
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(path_, "line " + std::to_string(line_) + ": " + what);
  }

  void take(const std::vector<std::string_view>& words) {
    if (words.front() == "format") return takeFormat(words);
    if (words.front() == "element") return takeElement(words);
    if (words.front() == "property") return takeProperty(words);
    fail(quote(words.front()) + " does not belong in a PLY header (format, element, property, comment, end_header)");
  }

  void takeFormat(const std::vector<std::string_view>& words) {
    constexpr std::array<std::string_view, 3> kEncodings = {"ascii", "binary_little_endian", "binary_big_endian"};
    if (has_format_) fail("a second line 'format'");
    const auto found = words.size() == 3 ? std::find(kEncodings.begin(), kEncodings.end(), words[1]) : kEncodings.end();
    if (found == kEncodings.end() || words[2] != "1.0")
      fail("the format is not one of 'ascii 1.0', 'binary_little_endian 1.0', 'binary_big_endian 1.0'");
    header_.encoding = static_cast<PlyEncoding>(found - kEncodings.begin());
    has_format_ = true;
  }

  void takeElement(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("expected 'element NAME COUNT'");
    PlyElement element;
    element.name = words[1];
    element.line = line_;
    if (!elements_.insert(element.name).second) fail("a second element " + quote(element.name));
    properties_.clear();
    const auto [end, error] = std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
    if (error != std::errc() || end != words[2].data() + words[2].size())
      fail("the number of " + quote(element.name) + " is " + quote(words[2]) + ", not a whole number" +
           (error == std::errc::result_out_of_range ? " of 64 bits" : " >= 0"));
    header_.elements.push_back(std::move(element));
  }

  void takeProperty(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before any element");
    PlyProperty property;
    property.is_list = words.size() > 1 && words[1] == "list";
    if (words.size() != (property.is_list ? 5u : 3u))
      fail("expected 'property TYPE NAME' or 'property list COUNT_TYPE TYPE NAME'");
    if (property.is_list) {
      property.count_type = type(words[2]);
      if (!isWhole(property.count_type))
        fail("the length of a list has the type " + quote(words[2]) + ", expected a type of whole numbers");
    }
    property.type = type(words[words.size() - 2]);
    property.name = words.back();
    if (!properties_.insert(property.name).second) fail("the property " + quote(property.name) + " occurs twice");
    header_.elements.back().properties.push_back(std::move(property));
  }

  NumberType type(std::string_view word) const {
    for (const auto& [name, type] : kTypes)
      if (name == word) return type;
    fail(quote(word) + " is not a type of a property (uchar, int, float, double ...)");
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  std::size_t line_ = 0;
  bool has_format_ = false;
  std::set<std::string> elements_;    // names so far
  std::set<std::string> properties_;  // names of the current element so far
  PlyHeader header_;
};

}  // namespace

std::size_t PlyElement::minSize() const {
  std::size_t size = 0;
  for (const PlyProperty& property : properties) size += sizeOf(property.is_list ? property.count_type : property.type);
  return size;
}

PlyHeader parsePlyHeader(const std::filesystem::path& path, std::string_view bytes) {
  return HeaderParser(path, bytes).parse();
}

bool isPlyMesh(const std::filesystem::path& path) {
  const MappedFile file(path);
  if (file.bytes().substr(0, 3) != "ply") return false;
  const PlyHeader header = parsePlyHeader(path, file.bytes());
  return std::any_of(header.elements.begin(), header.elements.end(),
                     [](const PlyElement& element) { return element.name == "face" && element.count > 0; });
}

}  // namespace gaussmap::detail
