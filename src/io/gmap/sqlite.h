// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct sqlite3;
struct sqlite3_stmt;

namespace gaussmap::detail {

/// Owns a SQLite handle. Every error becomes a FileError with the path of the database.
///
/// Map files are only ever replaced as a whole. So a file is read without locks, and journals beside it are ignored.
/// The size of the file limits the steps per statement and the length of the values, whatever its pages say.
class Database {
 public:
  enum class Mode {
    ReadOnly,
    CreateForBulkWrite,
    ChangeCopy,  ///< changes a file that nobody else reads: no journal, but the limits of ReadOnly
    InMemory     ///< the path is only used in messages
  };
  Database(const std::filesystem::path& path, Mode mode);

  void execute(const std::string& sql);
  /// Reads the first bytes of a blob, at most `most`, and stores its size. Returns false if there is no such blob, or
  /// if the database is damaged.
  bool readBlobStart(const char* table, const char* column, std::int64_t row, std::size_t most,
                     std::vector<char>& bytes, std::size_t& size) const;
  const std::filesystem::path& path() const { return path_; }
  sqlite3* handle() const { return handle_.get(); }
  [[noreturn]] void fail(const std::string& doing) const;
  [[noreturn]] void fail() const;

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  friend class Statement;
  void distrust();
  /// Allows the program to write a value of this length, although it is longer than the file.
  void allowLength(std::size_t bytes) const;
  /// Gives a new statement the full number of steps.
  void renewSteps() const;

  std::filesystem::path path_;
  Mode mode_;
  std::unique_ptr<std::int64_t> steps_left_;  // in thousands
  std::int64_t max_steps_ = 0;
  std::unique_ptr<sqlite3, Close> handle_;
};

class Statement {
 public:
  Statement(const Database& database, const std::string& sql);

  void bind(int index, std::int64_t value);
  void bind(int index, std::string_view text);
  void bindBlob(int index, std::string_view bytes);
  /// Returns true if there is a row, false if the statement is done.
  bool step();
  void reset();

  std::int64_t integer(int column) const;
  std::string text(int column) const;
  /// The result is valid until the next step().
  std::string_view blob(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  const Database& database_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

}  // namespace gaussmap::detail
