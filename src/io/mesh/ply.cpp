// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "gaussmap/io/mesh/ply.h"
#include "io/files/mapped_file.h"
#include "io/files/text.h"
#include "io/ply/ply_header.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "only the values of big-endian files are byte-swapped");

namespace gaussmap {
using namespace detail;

namespace {

constexpr double kFarthest = 1e70;  // [m], see checkMesh()

/// Reads the values of an ASCII body, one element per line.
class AsciiValues {
 public:
  AsciiValues(const std::filesystem::path& path, const PlyHeader& header, std::string_view bytes)
      : path_(path),
        place_(bytes.data() + header.data_offset),
        end_(bytes.data() + bytes.size()),
        line_(header.data_line) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(path_, "line " + std::to_string(line_) + ": " + what);
  }

  /// Returns true if the rest of the file can hold these elements. Each value takes a digit, and a separator unless it
  /// is the last value.
  bool mayHold(const PlyElement& element) const {
    std::size_t bytes = 0;
    return !__builtin_mul_overflow(element.count, 2 * element.minWords(), &bytes) &&
           bytes <= static_cast<std::size_t>(end_ - place_) + 1;
  }
  std::size_t maxCount(NumberType) const { return static_cast<std::size_t>(end_ - place_) / 2 + 1; }

  void beginElement(const PlyElement& element, std::size_t i) {
    while (place_ != end_ && (isBlank(*place_) || *place_ == '\n')) line_ += *place_++ == '\n';
    if (place_ == end_)
      throw FileError(path_, "the data end after " + std::to_string(i) + " of " + std::to_string(element.count) +
                                 " elements " + quote(element.name));
  }
  void endElement(const PlyElement& element) {
    skipBlanks();
    if (place_ != end_ && *place_ != '\n') fail("more values than an element " + quote(element.name) + " has");
  }
  void finish() {
    while (place_ != end_ && (isBlank(*place_) || *place_ == '\n')) line_ += *place_++ == '\n';
    if (place_ != end_) fail("more data than the header says");
  }

  double number(NumberType type) {
    double value = 0.0;
    const std::string_view word = takeWord();
    if (!parseNumber(word, value)) fail(quote(word) + " is not a number");
    if (type == NumberType::Float32 && std::abs(value) <= double{std::numeric_limits<float>::max()})
      return double{static_cast<float>(value)};  // the same value as in a binary file
    return value;
  }
  std::int64_t whole(NumberType) {
    std::int64_t value = 0;
    const std::string_view word = takeWord();
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) fail(quote(word) + " is not a whole number");
    return value;
  }
  void skip(NumberType, std::size_t count) {
    while (count-- > 0) takeWord();
  }

 private:
  void skipBlanks() {
    while (place_ != end_ && isBlank(*place_)) ++place_;
  }
  std::string_view takeWord() {
    skipBlanks();
    const char* const first = place_;
    while (place_ != end_ && !isBlank(*place_) && *place_ != '\n') ++place_;
    if (first == place_) fail("ends before its last value");
    return {first, static_cast<std::size_t>(place_ - first)};
  }

  const std::filesystem::path& path_;
  const char* place_;
  const char* end_;
  std::size_t line_;
};

/// Reads the values of a binary body.
class BinaryValues {
 public:
  BinaryValues(const std::filesystem::path& path, const PlyHeader& header, std::string_view bytes)
      : path_(path), bytes_(bytes), place_(header.data_offset), is_big_(header.encoding == PlyEncoding::BigEndian) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(path_, "byte " + std::to_string(element_) + ": " + what);
  }

  bool mayHold(const PlyElement& element) const {
    std::size_t bytes = 0;
    return !__builtin_mul_overflow(element.count, element.minSize(), &bytes) && bytes <= bytes_.size() - place_;
  }
  std::size_t maxCount(NumberType type) const { return (bytes_.size() - place_) / sizeOf(type); }

  void beginElement(const PlyElement&, std::size_t) { element_ = place_; }
  void endElement(const PlyElement&) {}
  void finish() {}

  double number(NumberType type) {
    if (type == NumberType::Float64) return take<double>();
    if (type == NumberType::Float32) return double{take<float>()};
    return static_cast<double>(whole(type));
  }
  std::int64_t whole(NumberType type) {
    switch (type) {
      case NumberType::Int8:
        return take<std::int8_t>();
      case NumberType::UInt8:
        return take<std::uint8_t>();
      case NumberType::Int16:
        return take<std::int16_t>();
      case NumberType::UInt16:
        return take<std::uint16_t>();
      case NumberType::Int32:
        return take<std::int32_t>();
      case NumberType::UInt32:
        return take<std::uint32_t>();
      case NumberType::Float32:
      case NumberType::Float64:
        break;
    }
    fail("a whole number was expected");
  }
  void skip(NumberType type, std::size_t count) {
    if (count > maxCount(type)) fail("the file is cut off inside this element");
    place_ += count * sizeOf(type);
  }

 private:
  template <typename T>
  T take() {
    if (sizeof(T) > bytes_.size() - place_) fail("the file is cut off inside this element");
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + place_, sizeof(T));
    if (is_big_) std::reverse(raw, raw + sizeof(T));
    place_ += sizeof(T);
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  std::size_t place_;
  std::size_t element_ = 0;  // position of the current element [bytes]
  bool is_big_;
};

const PlyElement* find(const PlyHeader& header, const char* name) {
  for (const PlyElement& element : header.elements)
    if (element.name == name) return &element;
  return nullptr;
}

template <typename Values>
class BodyParser {
 public:
  BodyParser(const std::filesystem::path& path, const PlyHeader& header, std::string_view bytes)
      : path_(path), header_(header), values_(path, header, bytes) {}

  TriangleMesh parse() {
    checkElements();
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty() && element.count > 0) failAt(element, "has no property");
      if (!values_.mayHold(element))
        failAt(element,
               std::to_string(element.count) +
                   " of them do not fit into the rest of the file: the file is cut off, or the number is wrong");
      for (std::size_t i = 0; i < element.count; ++i) {
        values_.beginElement(element, i);
        if (element.name == "vertex") {
          takeVertex(element, i);
        } else if (element.name == "face") {
          takeFace(element, i);
        } else {
          for (const PlyProperty& property : element.properties) skip(property);
        }
        values_.endElement(element);
      }
    }
    values_.finish();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void failAt(const PlyElement& element, const std::string& what) const {
    throw FileError(path_, "line " + std::to_string(element.line) + ": element " + quote(element.name) + ": " + what);
  }

  void checkElements() {
    const PlyElement *const vertex = find(header_, "vertex"), *const face = find(header_, "face");
    if (!vertex) throw FileError(path_, "the header has no element vertex");
    if (!face) {
      const bool has_strips = find(header_, "tristrips") != nullptr;
      throw FileError(path_, has_strips ? "triangle strips are not supported: save the mesh with an element face"
                                        : "the header has no element face: a point cloud is not a mesh");
    }
    for (const char* const name : {"x", "y", "z"}) {
      const auto is_axis = [&](const PlyProperty& property) { return property.name == name && !property.is_list; };
      if (std::none_of(vertex->properties.begin(), vertex->properties.end(), is_axis))
        failAt(*vertex, "has no property " + quote(name));
    }
    if (std::none_of(face->properties.begin(), face->properties.end(), isCorners))
      failAt(*face, "has no list of whole numbers 'vertex_indices' or 'vertex_index'");
    vertices_ = vertex->count;
    if (vertices_ > std::numeric_limits<std::uint32_t>::max()) failAt(*vertex, "more than 2^32 - 1");
  }

  static bool isCorners(const PlyProperty& property) {
    return property.is_list && isWhole(property.type) &&
           (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  std::size_t length(const PlyProperty& list) {
    const std::int64_t length = values_.whole(list.count_type);
    if (length < 0) values_.fail("a list of " + std::to_string(length) + " entries");
    if (static_cast<std::uint64_t>(length) > values_.maxCount(list.type))
      values_.fail("a list of " + std::to_string(length) + " entries does not fit into the rest of the file");
    return static_cast<std::size_t>(length);
  }

  void skip(const PlyProperty& property) { values_.skip(property.type, property.is_list ? length(property) : 1); }

  void takeVertex(const PlyElement& element, std::size_t i) {
    Eigen::Vector3d vertex;
    for (const PlyProperty& property : element.properties) {
      const bool is_axis =
          !property.is_list && property.name.size() == 1 && property.name >= "x" && property.name <= "z";
      if (is_axis) {
        vertex(property.name.front() - 'x') = values_.number(property.type);
      } else {
        skip(property);
      }
    }
    if (!(vertex.cwiseAbs().array() < kFarthest).all())
      values_.fail("vertex " + std::to_string(i) + " is not finite or is farther than 1e70 m");
    mesh_.vertices.push_back(vertex);
  }

  void takeFace(const PlyElement& element, std::size_t i) {
    bool is_taken = false;
    for (const PlyProperty& property : element.properties) {
      if (is_taken || !isCorners(property)) {
        skip(property);
        continue;
      }
      is_taken = true;
      const std::size_t corners = length(property);
      if (corners < 3) values_.fail("face " + std::to_string(i) + " has " + std::to_string(corners) + " corners");
      const std::uint32_t first = takeIndex(property.type, i);
      std::uint32_t before = takeIndex(property.type, i);
      for (std::size_t corner = 2; corner < corners; ++corner) {
        const std::uint32_t next = takeIndex(property.type, i);
        mesh_.triangles.push_back({first, before, next});
        before = next;
      }
    }
  }

  std::uint32_t takeIndex(NumberType type, std::size_t face) {
    const std::int64_t index = values_.whole(type);
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_)
      values_.fail("face " + std::to_string(face) + ": vertex " + std::to_string(index) + " of " +
                   std::to_string(vertices_) + " does not exist");
    return static_cast<std::uint32_t>(index);
  }

  const std::filesystem::path& path_;
  const PlyHeader& header_;
  Values values_;
  std::size_t vertices_ = 0;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh readPly(const std::filesystem::path& path) {
  const MappedFile file(path);
  const PlyHeader header = parsePlyHeader(path, file.bytes());
  TriangleMesh mesh = header.encoding == PlyEncoding::Ascii
                          ? BodyParser<AsciiValues>(path, header, file.bytes()).parse()
                          : BodyParser<BinaryValues>(path, header, file.bytes()).parse();
  file.requireWhole();
  return mesh;
}

}  // namespace gaussmap
