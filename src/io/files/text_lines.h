// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

namespace gaussmap::detail {

/// The lines of a text file one after the other, plain or gzip (told by its first bytes, not by its name). Expands
/// as it goes: a small file that expands to a huge one costs time, not memory.
class TextLines {
 public:
  /// Throws FileError if there is no such file, or it is a directory, a pipe, a device, or may not be read.
  explicit TextLines(const std::filesystem::path& path);
  ~TextLines();
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  /// The next line without its end; false behind the last one. Lines are cut at 16 MB. The end of a damaged gzip file
  /// is behind the last whole line before the damage.
  bool next(std::string& line);
  /// Of the line that next() gave, from 1; after the last one, of the one that would follow.
  std::size_t number() const { return number_; }
  /// Why the text ends before its end, once next() said so; empty if nothing is wrong.
  const std::string& damage() const { return damage_; }

 private:
  struct Source;
  struct PlainSource;
  struct GzipSource;
  std::unique_ptr<Source> source_;
  std::string buffer_;
  std::size_t read_ = 0;  // bytes of the buffer that were given
  std::size_t number_ = 0;
  std::string damage_;
};

}  // namespace gaussmap::detail
