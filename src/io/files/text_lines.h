// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include "gaussmap/version.h"

namespace gaussmap::detail {

/// Reads a text file line by line, plain or gzip (detected by the first bytes, not by the name). The text is expanded
/// piece by piece, so a small file that expands to a huge one costs time, but no memory.
class GAUSSMAP_API TextLines {
 public:
  /// Opens a file. Throws FileError if it does not exist, is a directory, a pipe or a device, or cannot be read.
  explicit TextLines(const std::filesystem::path& path);
  ~TextLines();
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  /// Reads the next line without its line end. Returns false after the last line. Lines are cut at 16 MiB. A damaged
  /// gzip file ends after the last whole line before the damage.
  bool next(std::string& line);
  /// Number of the line that next() has read, from 1. After the end, it is the number that the next line would have.
  std::size_t number() const { return number_; }
  /// Why the text ended too early, after next() has returned false; empty if nothing is wrong.
  const std::string& damage() const { return damage_; }

 private:
  struct Source;
  struct PlainSource;
  struct GzipSource;
  std::unique_ptr<Source> source_;
  std::string buffer_;
  std::size_t read_ = 0;  // bytes of the buffer that next() has used
  std::size_t number_ = 0;
  std::string damage_;
};

}  // namespace gaussmap::detail
