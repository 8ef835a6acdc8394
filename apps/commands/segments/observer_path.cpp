// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <cmath>
#include <fstream>

#include "commands/segments/segments.h"
#include "gaussmap/core/error.h"
#include "gaussmap/io/scans/pose_file.h"

namespace gaussmap::app {
namespace {

/// Returns the words of a line without its comment.
std::vector<std::string> wordsOfLine(std::string line) {
  line.resize(std::min(line.size(), line.find('#')));
  std::vector<std::string> words;
  const char* const separators = " \t\r,;";
  for (std::size_t at = line.find_first_not_of(separators); at != std::string::npos;) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(separators, end);
  }
  return words;
}

double coordinate(const std::string& word, const std::string& path, std::size_t line) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    throw FileError(path,
                    "line " + std::to_string(line) + ": '" + word + "' is not a coordinate in metres; expected x y");
  return value;
}

}  // namespace

std::vector<Vector<2>> readObserverPath(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw FileError(path, "cannot be opened");
  std::vector<Vector<2>> positions;
  std::string text;
  for (std::size_t line = 1; std::getline(file, text); ++line) {
    const std::vector<std::string> words = wordsOfLine(text);
    if (words.empty()) continue;
    if (positions.empty() && words.size() > 2) {  // not "x y", so the file has poses
      for (const PoseFile::Entry& entry : readPoseFile(path).entries)
        if (entry.pose) positions.push_back(entry.pose->translation.head<2>());
      break;
    }
    if (words.size() != 2)
      throw FileError(
          path, "line " + std::to_string(line) + " has " + std::to_string(words.size()) + " numbers; expected x y");
    const double x = coordinate(words[0], path, line), y = coordinate(words[1], path, line);
    positions.emplace_back(x, y);
  }
  if (positions.empty()) throw FileError(path, "no position; expected x y per line, or poses");
  return positions;
}

}  // namespace gaussmap::app
