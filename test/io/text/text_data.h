// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "io/files/text.h"
#include "io/formats/scan_file.h"

// Reads the files of test/data/formats/text and whole scans, for tests.
namespace gaussmap::test {

/// Returns the path of a file that make.py has written.
inline std::filesystem::path textData(const std::string& name) {
  return std::filesystem::path(GAUSSMAP_TEST_DATA) / "formats" / "text" / name;
}

/// Returns the numbers of a file, one vector per line.
inline std::vector<std::vector<double>> numbersOf(const std::filesystem::path& path) {
  std::vector<std::vector<double>> rows;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    rows.emplace_back();
    for (const std::string_view word : detail::splitWords(line)) {
      rows.back().push_back(0.0);
      if (!detail::parseNumber(word, rows.back().back())) rows.back().back() = -12345.678;
    }
  }
  return rows;
}

/// Returns all points of a scan with their values: x y z, then the values in the order of valueNames().
inline std::vector<std::vector<double>> rowsOf(const ScanReader& reader) {
  std::vector<std::vector<double>> rows;
  PointBlock<3> block;
  for (std::size_t first = 0; first < reader.size(); first += block.size) {
    reader.read(first, block);
    for (std::size_t i = 0; i < block.size; ++i)
      rows.push_back({block.coordinate[0][i], block.coordinate[1][i], block.coordinate[2][i]});
    if (block.size == 0) break;
  }
  for (const std::string& name : reader.valueNames()) {
    const std::vector<double> values = reader.values(name);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(values.at(i));
  }
  reader.requireWhole();
  return rows;
}

/// Returns all points of all scans.
inline std::vector<std::vector<double>> rowsOf(const detail::ScanFile& file) {
  std::vector<std::vector<double>> rows;
  for (std::size_t scan = 0; scan < file.size(); ++scan)
    for (std::vector<double>& row : rowsOf(*file.open(scan))) rows.push_back(std::move(row));
  return rows;
}

/// Returns the names of the values of the first scan, separated by blanks.
inline std::string namesIn(const detail::ScanFile& file) {
  std::string text;
  for (const std::string& name : file.open(0)->valueNames()) text += (text.empty() ? "" : " ") + name;
  return text;
}

/// Returns rows as text, to compare them with NaN: "1 2 nan".
inline std::string textOf(const std::vector<std::vector<double>>& rows) {
  std::ostringstream text;
  text.precision(17);
  for (const std::vector<double>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text << ' ';
      if (row[i] != row[i]) {
        text << "nan";
      } else {
        text << row[i];
      }
    }
    text << '\n';
  }
  return text.str();
}

}  // namespace gaussmap::test
