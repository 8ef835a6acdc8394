// SPDX-License-Identifier: BSD-3-Clause
#include "io/gmap/sqlite.h"

#include <sqlite3.h>

#include <algorithm>
#include <cctype>
#include <system_error>

#include "gaussmap/core/error.h"

namespace gaussmap::detail {
namespace {

constexpr std::uintmax_t kLongestValue = 1000000000;  // SQLite's own limit [bytes]

/// Returns the absolute path, because names like ":memory:" have a special meaning in SQLite.
std::string absolutePath(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::absolute(path, error);
  return error ? path.string() : full.string();
}

/// Returns a URI in which every special character is written as %hh.
std::string immutableUri(const std::filesystem::path& path) {
  constexpr const char* kHexDigits = "0123456789ABCDEF";
  std::string uri = "file:";
  for (const char c : absolutePath(path)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && (std::isalnum(byte) || c == '/' || c == '.' || c == '-' || c == '_'))
      uri += c;
    else
      uri += {'%', kHexDigits[byte >> 4], kHexDigits[byte & 15]};
  }
  return uri + "?immutable=1";
}

}  // namespace

void Database::Close::operator()(sqlite3* handle) const {
  sqlite3_close(handle);
}
void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Database::Database(const std::filesystem::path& path, Mode mode) : path_(path), mode_(mode) {
  const bool read_only = mode == Mode::ReadOnly;
  sqlite3* raw = nullptr;
  const int code =
      read_only
          ? sqlite3_open_v2(immutableUri(path).c_str(), &raw, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr)
          : sqlite3_open_v2(
                mode == Mode::InMemory ? ":memory:" : absolutePath(path).c_str(), &raw,
                mode == Mode::ChangeCopy ? SQLITE_OPEN_READWRITE : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  handle_.reset(raw);
  if (code != SQLITE_OK) fail("cannot be opened");
  if (read_only || mode == Mode::ChangeCopy) distrust();
  if (!read_only)  // a part file needs no journal: if the writer dies, no reader has seen it
    execute("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
}

bool Database::readBlobStart(const char* table, const char* column, std::int64_t row, std::size_t most,
                             std::vector<char>& bytes, std::size_t& size) const {
  renewSteps();
  sqlite3_blob* blob = nullptr;
  if (sqlite3_blob_open(handle_.get(), "main", table, column, row, 0, &blob) != SQLITE_OK) {
    sqlite3_blob_close(blob);
    return false;
  }
  size = static_cast<std::size_t>(sqlite3_blob_bytes(blob));
  bytes.resize(std::min(size, most));
  const int code = sqlite3_blob_read(blob, bytes.data(), static_cast<int>(bytes.size()), 0);
  sqlite3_blob_close(blob);
  return code == SQLITE_OK;
}

void Database::distrust() {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path_, error);
  if (error) throw FileError(path_, "cannot be read: " + error.message());
  sqlite3_limit(handle(), SQLITE_LIMIT_LENGTH,
                static_cast<int>(std::clamp<std::uintmax_t>(bytes, 100000, kLongestValue)));
  for (const int danger : {SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_TRIGGER, SQLITE_DBCONFIG_ENABLE_VIEW})
    sqlite3_db_config(handle(), danger, 0, nullptr);
  // The steps are limited, because pages that point to each other in a circle, or a view instead of a table, could be
  // read forever. A row takes about 20 steps and at least 20 bytes.
  max_steps_ = 1000 + static_cast<std::int64_t>(bytes / 100);
  steps_left_ = std::make_unique<std::int64_t>(max_steps_);
  sqlite3_progress_handler(
      handle(), 1000, [](void* left) { return --*static_cast<std::int64_t*>(left) < 0 ? 1 : 0; }, steps_left_.get());
}

void Database::allowLength(std::size_t bytes) const {
  constexpr std::size_t kRestOfRow = 1000;
  const auto needed = static_cast<int>(std::min<std::size_t>(bytes + kRestOfRow, kLongestValue));
  if (sqlite3_limit(handle(), SQLITE_LIMIT_LENGTH, -1) < needed) sqlite3_limit(handle(), SQLITE_LIMIT_LENGTH, needed);
}

void Database::renewSteps() const {
  if (steps_left_) *steps_left_ = max_steps_;
}

void Database::execute(const std::string& sql) {
  if (sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail();
}

void Database::fail(const std::string& doing) const {
  throw FileError(path_, doing + ": " + (handle() ? sqlite3_errmsg(handle()) : "out of memory"));
}

void Database::fail() const {
  fail(mode_ == Mode::ReadOnly ? "is damaged" : "cannot be written");
}

Statement::Statement(const Database& database, const std::string& sql) : database_(database) {
  database.renewSteps();
  sqlite3_stmt* raw = nullptr;
  if (sqlite3_prepare_v2(database.handle(), sql.c_str(), -1, &raw, nullptr) != SQLITE_OK) database.fail();
  handle_.reset(raw);
}

void Statement::bind(int index, std::int64_t value) {
  if (sqlite3_bind_int64(handle_.get(), index, value) != SQLITE_OK) database_.fail();
}

void Statement::bind(int index, std::string_view text) {
  database_.allowLength(text.size());
  if (sqlite3_bind_text64(handle_.get(), index, text.data(), text.size(), SQLITE_TRANSIENT, SQLITE_UTF8) != SQLITE_OK)
    database_.fail();
}

void Statement::bindBlob(int index, std::string_view bytes) {
  database_.allowLength(bytes.size());
  if (sqlite3_bind_blob64(handle_.get(), index, bytes.data(), bytes.size(), SQLITE_TRANSIENT) != SQLITE_OK)
    database_.fail();
}

bool Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) database_.fail();
  return code == SQLITE_ROW;
}

void Statement::reset() {
  database_.renewSteps();
  sqlite3_reset(handle_.get());
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  return text ? std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))) : "";
}

std::string_view Statement::blob(int column) const {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(handle_.get(), column));
  return {bytes ? bytes : "", bytes ? static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column)) : 0};
}

}  // namespace gaussmap::detail
