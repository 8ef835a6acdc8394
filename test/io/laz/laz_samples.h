// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "gaussmap/core/scans.h"
#include "io/laz/laz_file.h"

// The LAZ files of other programs in test/data/formats/laz, see make.py there.
namespace gaussmap::test {

inline const std::filesystem::path kLazFolder = std::filesystem::path(GAUSSMAP_TEST_DATA) / "formats" / "laz";

inline std::string bytesOfFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

inline std::string lazSample(const std::string& name) {
  return bytesOfFile(kLazFolder / (name + ".laz"));
}

/// Returns the records that the independent reader gives for a sample.
inline std::string expectedRecords(const std::filesystem::path& laz) {
  static const std::regex kName("(laszip|lazperf)_(format[0-9](_extra|_channels)?).*");
  return bytesOfFile(kLazFolder / std::regex_replace(laz.filename().string(), kName, "$2.records"));
}

/// Returns all records of a file.
inline std::string recordsOf(const std::filesystem::path& path) {
  const auto source = detail::openLazSource(path);
  std::string records;
  detail::decodeLaz(*source, detail::kAllLazLayers, [&](const char* group, std::size_t count) {
    records.append(group, count * source->header.record_length);
  });
  return records;
}

/// Returns the position of the points: the offset of the table of chunks is there.
inline std::size_t dataOffset(const std::string& bytes) {
  std::uint32_t offset = 0;
  std::memcpy(&offset, bytes.data() + 96, sizeof offset);
  return offset;
}

/// Returns the position of the table of chunks.
inline std::size_t tableOffset(const std::string& bytes) {
  std::uint64_t offset = 0;
  std::memcpy(&offset, bytes.data() + dataOffset(bytes), sizeof offset);
  return offset;
}

template <typename T>
std::string changedAt(const std::string& bytes, std::size_t place, T value) {
  std::string changed = bytes;
  std::memcpy(&changed.at(place), &value, sizeof(value));
  return changed;
}

}  // namespace gaussmap::test
