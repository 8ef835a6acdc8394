// SPDX-License-Identifier: BSD-3-Clause
#include "io/ply/ply_vertices.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "gaussmap/core/error.h"
#include "io/files/binary_numbers.h"
#include "io/files/text.h"
#include "io/ply/ply_ascii.h"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "only the values of big-endian files are byte-swapped");

namespace gaussmap::detail {
namespace {

bool hasLists(const PlyElement& element) {
  return std::any_of(element.properties.begin(), element.properties.end(),
                     [](const PlyProperty& property) { return property.is_list; });
}

/// Walks over the elements of a binary body.
class PlyWalker {
 public:
  PlyWalker(const std::filesystem::path& path, std::string_view bytes, std::size_t place, bool is_big)
      : path_(path), bytes_(bytes), place_(place), is_big_(is_big) {}

  std::size_t place() const { return place_; }
  std::size_t room() const { return bytes_.size() - place_; }

  /// Skips all elements of a kind. PlyVertices has checked that they fit if their lists are empty.
  void skip(const PlyElement& element) {
    if (!hasLists(element)) {
      place_ += element.count * element.minSize();
      return;
    }
    for (std::size_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) skip(element, i, property);
  }

  /// Skips one property of element `i`.
  void skip(const PlyElement& element, std::size_t i, const PlyProperty& property) {
    const char* const value = take(element, i, sizeOf(property.is_list ? property.count_type : property.type), 1);
    if (!property.is_list) return;
    double length = 0.0;
    loadNumbers(property.count_type, is_big_, value, 0, 1, &length);
    if (length < 0.0) fail(element, i, "a list of " + std::to_string(static_cast<std::int64_t>(length)) + " entries");
    take(element, i, sizeOf(property.type), static_cast<std::size_t>(length));
  }

  /// Takes a number, which is not a list.
  double number(const PlyElement& element, std::size_t i, const PlyProperty& property) {
    double value = 0.0;
    loadNumbers(property.type, is_big_, take(element, i, sizeOf(property.type), 1), 0, 1, &value);
    return value;
  }

 private:
  [[noreturn]] void fail(const PlyElement& element, std::size_t i, const std::string& what) const {
    throw FileError(path_, "byte " + std::to_string(place_) + ": element " + quote(element.name) + " " +
                               std::to_string(i) + ": " + what);
  }

  /// Moves behind `count` numbers and returns the first one.
  const char* take(const PlyElement& element, std::size_t i, std::size_t size, std::size_t count) {
    if (count > room() / size)
      fail(element, i,
           count == 1 ? "the file is cut off"
                      : "a list of " + std::to_string(count) + " entries does not fit into the file");
    const char* const first = bytes_.data() + place_;
    place_ += count * size;
    return first;
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  std::size_t place_;
  bool is_big_;
};

}  // namespace

PlyVertices::PlyVertices(const std::filesystem::path& path, PlyHeader header, std::string_view bytes)
    : path_(path), header_(std::move(header)), bytes_(bytes), first_(header_.data_offset) {
  const auto found = std::find_if(header_.elements.begin(), header_.elements.end(),
                                  [](const PlyElement& element) { return element.name == "vertex"; });
  if (found == header_.elements.end()) throw FileError(path, "the header has no element vertex");
  vertex_ = static_cast<std::size_t>(found - header_.elements.begin());

  const bool is_ascii = header_.encoding == PlyEncoding::Ascii;
  PlyWalker walker(path_, bytes_, first_, header_.encoding == PlyEncoding::BigEndian);
  std::size_t words = 0;
  for (std::size_t i = 0; i <= vertex_; ++i) {
    const PlyElement& element = header_.elements[i];
    const auto failHere = [&](const std::string& what) {
      throw FileError(path, "line " + std::to_string(element.line) + ": element " + quote(element.name) + ": " + what);
    };
    if (element.properties.empty() && element.count > 0) failHere("has no property");
    // Each word of an ASCII file takes a character, and a separator unless it is the last word.
    std::size_t size = 0;
    const std::size_t each = is_ascii ? element.minWords() : element.minSize();
    const bool fits = !__builtin_mul_overflow(element.count, each, &size) && size <= walker.room() &&
                      (!is_ascii || (words += size) <= walker.room() / 2 + 1);
    if (!fits)
      failHere(std::to_string(element.count) +
               " of them do not fit into the rest of the file: the file is cut off, or the number is wrong");
    if (i < vertex_ && !is_ascii) walker.skip(element);
  }
  first_ = walker.place();
  for (const PlyProperty& property : vertex().properties) {
    places_.push_back(record_size_);
    record_size_ += sizeOf(property.type);
  }
  if (is_ascii || hasLists(vertex())) record_size_ = 0;
}

bool PlyVertices::hasElement(std::string_view name) const {
  return std::any_of(header_.elements.begin(), header_.elements.end(),
                     [name](const PlyElement& element) { return element.name == name && element.count > 0; });
}

std::size_t PlyVertices::faces() const {
  std::size_t faces = 0;
  for (const PlyElement& element : header_.elements)
    if (element.name == "face") faces += element.count;
  return faces;
}

std::size_t PlyVertices::bytesBehind() const {
  if (!hasRecords() || vertex_ + 1 < header_.elements.size()) return 0;
  return bytes_.size() - first_ - size() * record_size_;
}

void PlyVertices::decode(std::size_t property, std::size_t first, std::size_t count, double* values) const {
  loadNumbers(vertex().properties[property].type, header_.encoding == PlyEncoding::BigEndian,
              bytes_.data() + first_ + first * record_size_ + places_[property], record_size_, count, values);
}

std::vector<std::vector<double>> PlyVertices::columns(const std::vector<std::size_t>& properties) const {
  if (header_.encoding == PlyEncoding::Ascii) return parsePlyAscii(path_, header_, bytes_, vertex_, properties);
  if (!hasRecords()) return walkedColumns(properties);
  std::vector<std::vector<double>> columns(properties.size());
  for (std::size_t i = 0; i < properties.size(); ++i) {
    columns[i].resize(size());
    decode(properties[i], 0, size(), columns[i].data());
  }
  return columns;
}

std::vector<std::vector<double>> PlyVertices::walkedColumns(const std::vector<std::size_t>& properties) const {
  std::vector<std::vector<double>> columns(properties.size(), std::vector<double>(size()));
  PlyWalker walker(path_, bytes_, first_, header_.encoding == PlyEncoding::BigEndian);
  for (std::size_t i = 0; i < size(); ++i) {
    std::size_t wanted = 0;
    for (std::size_t property = 0; property < vertex().properties.size(); ++property) {
      if (wanted < properties.size() && properties[wanted] == property)
        columns[wanted++][i] = walker.number(vertex(), i, vertex().properties[property]);
      else
        walker.skip(vertex(), i, vertex().properties[property]);
    }
  }
  return columns;
}

}  // namespace gaussmap::detail
