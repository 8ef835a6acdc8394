// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace gaussmap::test {

/// The vertices of a binary little-endian PLY file. The reader uses only the header.
struct PlyVertices {
  std::vector<std::string> names;                     ///< in the order of the file
  std::map<std::string, std::vector<double>> values;  ///< the values of every property
  std::vector<std::string> comments;
  std::size_t count = 0, faces = 0;
  std::size_t bytes_left = 0;  ///< number of bytes behind the vertices

  double at(const std::string& name, std::size_t i) const { return values.at(name).at(i); }
};

inline PlyVertices plyVertices(const std::string& bytes) {
  const std::string end = "end_header\n";
  const std::size_t data = bytes.find(end);
  if (data == std::string::npos) throw std::runtime_error("no header");
  PlyVertices ply;
  std::vector<std::string> types;
  std::istringstream header(bytes.substr(0, data));
  std::string line, element;
  for (int number = 0; std::getline(header, line); ++number) {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (number == 0 && line != "ply") throw std::runtime_error("no PLY file");
    if (number == 1 && line != "format binary_little_endian 1.0") throw std::runtime_error(line);
    if (first == "comment") ply.comments.push_back(line.substr(8));
    if (first == "element") {
      element = second;
      (element == "vertex" ? ply.count : ply.faces) = std::stoul(third);
    }
    if (first == "property" && element == "vertex") {
      types.push_back(second);
      ply.names.push_back(third);
    }
  }
  const char* place = bytes.data() + data + end.size();
  const char* const last = bytes.data() + bytes.size();
  const auto take = [&](auto value) {
    if (place + sizeof value > last) throw std::runtime_error("cut off");
    std::memcpy(&value, place, sizeof value);
    place += sizeof value;
    return static_cast<double>(value);
  };
  for (std::size_t i = 0; i < ply.count; ++i)
    for (std::size_t property = 0; property < types.size(); ++property)
      ply.values[ply.names[property]].push_back(types[property] == "uchar" ? take(static_cast<unsigned char>(0))
                                                                           : take(0.0f));
  ply.bytes_left = static_cast<std::size_t>(last - place);
  return ply;
}

}  // namespace gaussmap::test
