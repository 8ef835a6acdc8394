// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "gaussmap/io/pcd/pcd_reader.h"
#include "io/formats/scan_values.h"

// Writes PCD files for tests without the library.
namespace gaussmap::test {

template <typename T>
std::string bytesOf(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

/// Returns the header of n points with float x y z.
inline std::string xyzHeader(std::size_t points, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
         "WIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(points) + "\nDATA " +
         data + "\n";
}

/// Returns a valid LZF stream that compresses nothing: runs of at most 32 bytes, each after its length - 1.
inline std::string lzfLiterals(const std::string& bytes) {
  std::string stream;
  for (std::size_t first = 0; first < bytes.size(); first += 32) {
    const std::string run = bytes.substr(first, 32);
    stream += static_cast<char>(run.size() - 1);
    stream += run;
  }
  return stream;
}

/// Returns the body of DATA binary_compressed.
inline std::string compressedBody(const std::string& bytes) {
  const std::string stream = lzfLiterals(bytes);
  return bytesOf(static_cast<std::uint32_t>(stream.size())) + bytesOf(static_cast<std::uint32_t>(bytes.size())) +
         stream;
}

/// Returns all points of a file, axis by axis.
inline std::vector<std::vector<double>> readAll(const PcdReader& reader) {
  return coordinatesOf(reader);
}

}  // namespace gaussmap::test
