// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/rosbag2_database.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>

#include "io/bags/bag_bytes.h"
#include "io/files/file_contents.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

const std::string kTopics =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,serialization_format TEXT NOT "
    "NULL);"
    "INSERT INTO topics VALUES(1,'/a','a_msgs/msg/A','cdr'),(2,'/b','b_msgs/msg/B','cdr');";
const std::string kMessages =
    "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL, data BLOB NOT "
    "NULL);"
    "INSERT INTO messages VALUES(1,1,20,x'78'),(2,2,10,x'79'),(3,1,10,x'');";

class Rosbag2Databases : public testing::Test {
 protected:
  fs::path write(const std::string& sql, const std::string& name = "a.db3") const {
    const fs::path path = directory_.path() / name;
    fs::remove(path);
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
    sqlite3_close(database);
    return path;
  }
  void expectRefused(const fs::path& path, const std::vector<std::string>& pieces) const {
    test::expectComplaint(test::complaintOf([&] { test::texts(path); }), path, pieces);
  }
  test::TemporaryDirectory directory_;
};

TEST_F(Rosbag2Databases, AreReadInTheOrderOfTheTimes) {
  const fs::path path = write(kTopics + kMessages);
  EXPECT_TRUE(detail::isMessageFile(path));
  EXPECT_EQ(test::texts(path), (Lines{"/b 10 y", "/a 10 ", "/a 20 x"}));
  EXPECT_EQ(test::warningsOf(path), "");
}

TEST_F(Rosbag2Databases, AreRecognisedByTheirTables) {
  EXPECT_TRUE(detail::isMessageFile(write(kTopics + kMessages, "a.sqlite")));
  EXPECT_FALSE(detail::isMessageFile(write(kTopics, "other.sqlite")));
  EXPECT_TRUE(detail::isMessageFile(write(kTopics, "other.db3")));
  EXPECT_FALSE(detail::isMessageFile(write("PRAGMA application_id = 5;" + kTopics + kMessages, "map.gmap")));
  EXPECT_FALSE(detail::isMessageFile(directory_.path() / "none.db3"));
}

TEST_F(Rosbag2Databases, TellWhatIsMissing) {
  expectRefused(write(kTopics), {"no table messages", "not a recording of rosbag2"});
  expectRefused(write(kMessages), {"no table topics"});
  expectRefused(write("CREATE TABLE topics(id);" + kMessages), {"is damaged", "no such column: name"});
  expectRefused(write("CREATE VIEW topics AS SELECT 1 AS id;" + kMessages), {"no table topics"});
  const fs::path path = write(kTopics + kMessages + "DELETE FROM topics WHERE id = 2");
  EXPECT_EQ(test::texts(path), (Lines{"/a 10 ", "/a 20 x"}));
  EXPECT_NE(test::warningsOf(path).find("1 messages are ignored"), std::string::npos);
}

TEST_F(Rosbag2Databases, WarnAboutJournals) {
  const fs::path path = write(kTopics + kMessages);
  directory_.write("a.db3-wal", "");
  EXPECT_EQ(test::warningsOf(path), "");
  directory_.write("a.db3-wal", "something");
  EXPECT_NE(test::warningsOf(path).find("a.db3-wal can have messages"), std::string::npos);
  const std::string before = test::contentsOf(path);
  EXPECT_EQ(test::texts(path).size(), 3u);
  EXPECT_EQ(test::contentsOf(path), before);
  write(kTopics);  // SQLite removes the journal
  directory_.write("a.db3-wal", "something");
  expectRefused(path, {"no table messages; it may be in a.db3-wal", "sqlite3 a.db3 vacuum"});
}

TEST_F(Rosbag2Databases, DamagedOnesAreReadOrRefused) {
  const std::string whole = test::contentsOf(write(kTopics + kMessages));
  Random random(5);
  int refused = 0;
  constexpr int kRounds = 1500;
  for (int round = 0; round < kRounds; ++round) {
    std::string bytes = whole;
    if (round % 4 == 0) {
      bytes.resize(random.below(bytes.size()));
    } else {
      for (int change = 0; change < 8; ++change)
        bytes[random.below(bytes.size())] = static_cast<char>(random.below(256));
    }
    const fs::path path = directory_.write("damaged.db3", bytes);
    refused += !test::complaintOf([&] { test::texts(path); }).empty();
  }
  EXPECT_GT(refused, kRounds / 4);
  EXPECT_LT(refused, kRounds);
}

}  // namespace
}  // namespace gaussmap
