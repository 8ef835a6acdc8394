// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/rosbag2_database.h"

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "gaussmap/core/error.h"
#include "io/bags/compression.h"
#include "io/bags/message_index.h"
#include "io/gmap/sqlite.h"

namespace gaussmap::detail {
namespace {

constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);
constexpr std::size_t kMaxTopics = 65536;

/// Calls an action of the database. An expanded file has another path than the one that the user knows.
template <typename Action>
auto withShownPath(const std::filesystem::path& path, const std::filesystem::path& shown, const Action& action) {
  try {
    return action();
  } catch (const FileError& error) {
    const std::string what = error.what(), start = path.string() + ": ";
    throw FileError(shown, what.rfind(start, 0) == 0 ? what.substr(start.size()) : what);
  }
}

bool hasTable(const Database& database, const char* name) {
  Statement tables(database, "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = ?");
  tables.bind(1, std::string_view(name));
  return tables.step() && tables.integer(0) > 0;
}

class Rosbag2Database : public MessageFile {
 public:
  Rosbag2Database(const std::filesystem::path& path, const std::filesystem::path& shown)
      : path_(path), shown_(shown), database_(withShownPath(path, shown, [&] {
          return std::make_unique<Database>(path, Database::Mode::ReadOnly);
        })) {
    withShownPath(path_, shown_, [this] {
      lookForJournals();
      requireTables();
      readTopics();
      readPlaces();
      select_ = std::make_unique<Statement>(*database_, "SELECT data FROM messages WHERE rowid = ?");
    });
  }

  std::string kind() const override { return "rosbag2 sqlite3"; }
  const std::vector<MessageTopic>& topics() const override { return topics_; }
  const std::vector<MessagePlace>& messages() const override { return messages_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  std::vector<char> read(const MessagePlace& message) const override;
  MessageStart readStart(const MessagePlace& message, std::size_t most) const override;

 private:
  void lookForJournals();
  void requireTables() const;
  void readTopics();
  void readPlaces();

  std::filesystem::path path_, shown_;
  std::unique_ptr<Database> database_;
  std::string journal_;  // name of a file beside the database that SQLite has not merged into it
  std::map<std::int64_t, std::size_t> topic_numbers_;
  std::vector<MessageTopic> topics_;
  std::vector<MessagePlace> messages_;
  std::vector<std::string> warnings_;
  mutable std::mutex mutex_;  // of the statement
  std::unique_ptr<Statement> select_;
};

void Rosbag2Database::lookForJournals() {
  for (const char* const ending : {"-wal", "-journal"}) {
    std::filesystem::path beside = shown_;
    beside += ending;
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(beside, error);
    if (error || bytes == 0) continue;
    journal_ = beside.filename().string();
    warnings_.push_back("the recording was not finished: " + journal_ +
                        " can have messages that are not in the database yet; `sqlite3 " + shown_.filename().string() +
                        " vacuum` merges it");
    return;
  }
}

void Rosbag2Database::requireTables() const {
  for (const char* const table : {"topics", "messages"})
    if (!hasTable(*database_, table))
      throw FileError(path_, std::string("the database has no table ") + table +
                                 (journal_.empty() ? ": it is not a recording of rosbag2, or was not finished"
                                                   : "; it may be in " + journal_ + ": `sqlite3 " +
                                                         shown_.filename().string() + " vacuum` merges it"));
}

void Rosbag2Database::readTopics() {
  Statement rows(*database_, "SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  std::map<std::pair<std::string, std::string>, std::size_t> numbers;
  while (rows.step()) {
    if (topic_numbers_.size() >= kMaxTopics) throw FileError(path_, "the database has more than 65536 topics");
    MessageTopic topic;
    topic.name = rows.text(1);
    topic.type = typeName(rows.text(2));
    const std::string encoding = rows.text(3);
    if (topic.name.size() > 1000 || topic.type.size() > 1000)
      throw FileError(path_, "the name of a topic or of its type is longer than 1000 characters");
    if (encoding == "cdr") topic.encoding = MessageEncoding::Cdr;
    if (encoding == "ros1") topic.encoding = MessageEncoding::Ros1;
    const auto [place, added] =
        numbers.emplace(std::make_pair(topic.name, topic.type + ' ' + encoding), topics_.size());
    if (!topic_numbers_.emplace(rows.integer(0), place->second).second)
      throw FileError(path_, "topic " + std::to_string(rows.integer(0)) + " occurs twice");
    if (added) topics_.push_back(std::move(topic));
  }
}

void Rosbag2Database::readPlaces() {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path_, error), most = 1000000 + (error ? 0 : bytes);
  std::size_t unknown = 0;
  Statement rows(*database_, "SELECT rowid, topic_id, timestamp FROM messages ORDER BY rowid");
  while (rows.step()) {
    const auto topic = topic_numbers_.find(rows.integer(1));
    if (topic == topic_numbers_.end()) {
      ++unknown;
      continue;
    }
    if (messages_.size() >= most)
      throw FileError(path_, "the database has more than " + std::to_string(most) + " messages in " +
                                 std::to_string(bytes) + " bytes: it is damaged");
    messages_.push_back(
        {topic->second, std::chrono::nanoseconds(rows.integer(2)), static_cast<std::uint64_t>(rows.integer(0))});
    ++topics_[topic->second].messages;
  }
  if (unknown > 0)
    warnings_.push_back(std::to_string(unknown) +
                        " messages are ignored, because the table topics has no row for them");
  std::stable_sort(messages_.begin(), messages_.end(),
                   [](const MessagePlace& a, const MessagePlace& b) { return a.log_time < b.log_time; });
}

std::vector<char> Rosbag2Database::read(const MessagePlace& message) const {
  return withShownPath(path_, shown_, [&] {
    const auto row = static_cast<std::int64_t>(message.place);
    const auto fail = [&](const std::string& what) {
      throw FileError(path_, "row " + std::to_string(row) + " of the table messages " + what);
    };
    std::vector<char> data;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      select_->reset();
      select_->bind(1, row);
      if (!select_->step()) fail("cannot be found: the database is damaged");
      const std::string_view bytes = select_->blob(0);
      data.assign(bytes.begin(), bytes.end());
    }
    if (topics_.at(message.topic).encoding != MessageEncoding::Cdr || !isZstd({data.data(), data.size()})) return data;
    std::vector<char> expanded;
    const std::string error = expandMessage({data.data(), data.size()}, expanded);
    if (!error.empty()) fail("is compressed, but " + error);
    return expanded;
  });
}

MessageStart Rosbag2Database::readStart(const MessagePlace& message, std::size_t most) const {
  MessageStart start;
  bool is_read = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_read = database_->readBlobStart("messages", "data", static_cast<std::int64_t>(message.place),
                                       std::max(most, kZstdMagicBytes), start.bytes, start.size);
  }
  const bool is_packed = isZstd({start.bytes.data(), start.bytes.size()});
  return is_read && !is_packed ? start : MessageFile::readStart(message, most);
}

}  // namespace

bool isSqliteWithoutApplicationId(std::string_view start) {
  constexpr std::size_t kOwner = 68;  // application id, four bytes
  return start.substr(0, kSqliteMagic.size()) == kSqliteMagic && start.size() >= 100 &&
         start.substr(kOwner, 4) == std::string_view("\0\0\0\0", 4);
}

bool hasRosbag2Tables(const std::filesystem::path& path) {
  try {
    const Database database(path, Database::Mode::ReadOnly);
    return hasTable(database, "topics") && hasTable(database, "messages");
  } catch (const FileError&) {
    return false;
  }
}

std::unique_ptr<MessageFile> openRosbag2Database(const std::filesystem::path& path,
                                                 const std::filesystem::path& shown) {
  return std::make_unique<Rosbag2Database>(path, shown);
}

}  // namespace gaussmap::detail
