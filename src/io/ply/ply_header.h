// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gaussmap/version.h"
#include "io/files/binary_numbers.h"

namespace gaussmap::detail {

struct PlyProperty {
  std::string name;
  NumberType type = NumberType::Float32;  ///< type of the value, or of each entry of a list
  bool is_list = false;
  NumberType count_type = NumberType::UInt8;  ///< type of a list's length
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::size_t line = 0;  ///< line of the header
  std::vector<PlyProperty> properties;

  /// Minimum size of such an element, with empty lists: in bytes, or in words of an ASCII file.
  std::size_t minSize() const;
  std::size_t minWords() const { return properties.size(); }
};

enum class PlyEncoding { Ascii, LittleEndian, BigEndian };

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::Ascii;
  std::vector<PlyElement> elements;  ///< in the order of the data
  std::size_t data_offset = 0;       ///< position of the data [bytes]
  std::size_t data_line = 0;         ///< number of the first line of data; the first line of the file is 1
};

/// Reads the header at the start of a file. Throws FileError with the line that is wrong.
PlyHeader parsePlyHeader(const std::filesystem::path& path, std::string_view bytes);

/// Returns true if a file is a PLY file with faces, so a mesh and not a cloud. Throws FileError if the file cannot be
/// opened.
GAUSSMAP_API bool isPlyMesh(const std::filesystem::path& path);

}  // namespace gaussmap::detail
