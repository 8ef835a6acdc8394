// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "io/formats/scan_file.h"

// Reads whole scans, and compares them with a table of values that another program wrote.
namespace gaussmap::test {

/// Reads everything that the first scan of a file has.
inline void readAll(const detail::ScanFile& file) {
  file.warnings();
  const auto reader = file.open(0);
  PointBlock<3> block;
  for (std::size_t first = 0; reader->read(first, block), block.size > 0; first += block.size) continue;
  for (const std::string& name : reader->valueNames()) EXPECT_EQ(reader->values(name).size(), reader->size());
}

/// Returns x, y and z of all points of a scan. Reader: ScanReader or PcdReader.
template <typename Reader>
std::vector<std::vector<double>> coordinatesOf(const Reader& reader) {
  std::vector<std::vector<double>> axes(3);
  PointBlock<3> block;
  for (std::size_t first = 0; reader.read(first, block), block.size > 0; first += block.size)
    for (std::size_t axis = 0; axis < 3; ++axis)
      axes[axis].insert(axes[axis].end(), block.coordinate[axis], block.coordinate[axis] + block.size);
  return axes;
}

/// Returns the column x, y, z or the value of this name.
inline std::vector<double> columnOf(const ScanReader& reader, const std::string& name) {
  if (name.size() == 1 && name >= "x" && name <= "z")
    return coordinatesOf(reader)[static_cast<std::size_t>(name.front() - 'x')];
  return reader.values(name);
}

/// Expects the columns of a text file: names in the first line, then one line of numbers per point.
inline void expectValuesOf(const std::filesystem::path& table, const ScanReader& reader) {
  std::ifstream file(table);
  std::string line, word;
  ASSERT_TRUE(std::getline(file, line)) << table;
  std::vector<std::string> names;
  for (std::istringstream words(line); words >> word;) names.push_back(word);
  std::vector<std::vector<double>> columns(names.size());
  while (std::getline(file, line)) {
    std::istringstream words(line);
    for (std::vector<double>& column : columns)
      if (words >> word) column.push_back(std::strtod(word.c_str(), nullptr));
  }
  EXPECT_EQ(reader.valueNames().size() + 3, names.size()) << table;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::vector<double> read = columnOf(reader, names[i]);
    ASSERT_EQ(read.size(), columns[i].size()) << table << " " << names[i];
    ASSERT_EQ(read.size(), reader.size()) << table;
    for (std::size_t point = 0; point < read.size(); ++point) {
      const bool is_same =
          read[point] == columns[i][point] || (std::isnan(read[point]) && std::isnan(columns[i][point]));
      EXPECT_TRUE(is_same) << table << " " << names[i] << " of point " << point << ": " << read[point] << ", expected "
                           << columns[i][point];
    }
  }
}

}  // namespace gaussmap::test
