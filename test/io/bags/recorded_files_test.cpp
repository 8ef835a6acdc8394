// SPDX-License-Identifier: BSD-3-Clause
// Files that independent writers made, against what independent readers find, see test/data/formats/*/make.*.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "io/bags/bag_bytes.h"
#include "io/files/file_contents.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

using detail::MessageEncoding;
using detail::openMessageFile;
namespace fs = std::filesystem;

fs::path formatFile(const std::string& name) {
  return fs::path(GAUSSMAP_TEST_DATA) / "formats" / name;
}

std::vector<std::string> linesOf(const std::string& name) {
  std::ifstream file(formatFile(name));
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  EXPECT_FALSE(lines.empty()) << name;
  return lines;
}

struct Recorded {
  const char* file;
  const char* kind;
  const char* messages;
  const char* warning;
};

class RecordedFiles : public testing::TestWithParam<Recorded> {};

TEST_P(RecordedFiles, HaveTheMessagesOfTheIndependentReader) {
  const fs::path path = formatFile(GetParam().file);
  EXPECT_TRUE(detail::isMessageFile(path));
  test::expectStarts(*openMessageFile(path));
  const auto file = openMessageFile(path);
  EXPECT_EQ(file->kind(), GetParam().kind);
  std::vector<std::string> found = test::listed(*file), expected = linesOf(GetParam().messages);
  const auto& messages = file->messages();
  EXPECT_TRUE(std::is_sorted(messages.begin(), messages.end(),
                             [](const auto& a, const auto& b) { return a.log_time < b.log_time; }));
  if (path.extension() == ".bag") {  // rosbag orders messages with equal times by connection
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
  }
  EXPECT_EQ(found, expected);
  std::size_t total = 0;
  for (std::size_t topic = 0; topic < file->topics().size(); ++topic) {
    total += file->topics()[topic].messages;
    EXPECT_EQ(file->topics()[topic].messages,
              static_cast<std::size_t>(std::count_if(messages.begin(), messages.end(),
                                                     [&](const auto& message) { return message.topic == topic; })));
  }
  EXPECT_EQ(total, messages.size());
  const std::string warnings = test::warningsOf(path), expected_warning = GetParam().warning;
  if (expected_warning.empty())
    EXPECT_EQ(warnings, "");
  else
    EXPECT_NE(warnings.find(expected_warning), std::string::npos) << warnings;
}

INSTANTIATE_TEST_SUITE_P(
    All, RecordedFiles,
    testing::Values(Recorded{"mcap/ros2_none.mcap", "MCAP", "mcap/messages.txt", ""},
                    Recorded{"mcap/ros2_lz4.mcap", "MCAP (lz4)", "mcap/messages.txt", ""},
                    Recorded{"mcap/ros2_zstd.mcap", "MCAP (zstd)", "mcap/messages.txt", ""},
                    Recorded{"mcap/ros1_zstd.mcap", "MCAP (zstd)", "mcap/messages.txt", ""},
                    Recorded{"mcap/no_chunks.mcap", "MCAP", "mcap/messages.txt", ""},
                    Recorded{"mcap/no_index.mcap", "MCAP (zstd)", "mcap/messages.txt", ""},
                    Recorded{"mcap/no_summary.mcap", "MCAP (lz4)", "mcap/messages.txt", ""},
                    Recorded{"mcap/unfinished.mcap", "MCAP (zstd)", "mcap/unfinished.txt", "was not finished"},
                    Recorded{"ros1_bag/none.bag", "ROS 1 bag", "ros1_bag/messages.txt", ""},
                    Recorded{"ros1_bag/bz2.bag", "ROS 1 bag (bz2)", "ros1_bag/messages.txt", ""},
                    Recorded{"ros1_bag/lz4.bag", "ROS 1 bag (lz4)", "ros1_bag/messages.txt", ""},
                    Recorded{"ros1_bag/unfinished.bag", "ROS 1 bag (bz2)", "ros1_bag/unfinished.txt", "not finished"},
                    Recorded{"rosbag2/version1.db3", "rosbag2 sqlite3", "rosbag2/messages.txt", ""},
                    Recorded{"rosbag2/version4.db3", "rosbag2 sqlite3", "rosbag2/messages.txt", ""},
                    Recorded{"rosbag2/packed_messages.db3", "rosbag2 sqlite3", "rosbag2/messages.txt", ""},
                    Recorded{"rosbag2/split", "2 files: rosbag2 sqlite3", "rosbag2/messages.txt", ""}),
    [](const auto& test) {
      std::string name = test.param.file;
      for (char& c : name)
        if (c == '/' || c == '.') c = '_';
      return name;
    });

TEST(RecordedTopics, HaveTypesWithoutMsgAndTheEncodingOfTheFile) {
  const auto mcap = openMessageFile(formatFile("mcap/ros2_zstd.mcap"));
  ASSERT_EQ(mcap->topics().size(), 4u);  // two senders of /tf are one topic
  EXPECT_EQ(mcap->topics()[0].name, "/points");
  EXPECT_EQ(mcap->topics()[0].type, "sensor_msgs/PointCloud2");
  EXPECT_EQ(mcap->topics()[0].encoding, MessageEncoding::Cdr);
  EXPECT_EQ(mcap->topics()[0].messages, 10u);
  EXPECT_EQ(mcap->topics()[1].messages, 19u);
  EXPECT_EQ(mcap->topics()[3].type, "diagnostics");
  EXPECT_EQ(mcap->topics()[3].encoding, MessageEncoding::Other);
  const auto ros1 = openMessageFile(formatFile("mcap/ros1_zstd.mcap"));
  EXPECT_EQ(ros1->topics()[0].type, "sensor_msgs/PointCloud2");
  EXPECT_EQ(ros1->topics()[0].encoding, MessageEncoding::Ros1);
  const auto bag = openMessageFile(formatFile("ros1_bag/lz4.bag"));
  ASSERT_EQ(bag->topics().size(), 3u);
  EXPECT_EQ(bag->topics()[0].name, "/cloud");
  EXPECT_EQ(bag->topics()[0].type, "std_msgs/UInt8MultiArray");
  EXPECT_EQ(bag->topics()[0].encoding, MessageEncoding::Ros1);
  const auto database = openMessageFile(formatFile("rosbag2/version4.db3"));
  ASSERT_EQ(database->topics().size(), 3u);
  EXPECT_EQ(database->topics()[1].type, "tf2_msgs/TFMessage");
  EXPECT_EQ(database->topics()[2].encoding, MessageEncoding::Other);
}

TEST(RecordedMessages, AreReadByManyThreads) {
  for (const char* const name : {"mcap/ros2_zstd.mcap", "ros1_bag/bz2.bag", "rosbag2/version4.db3", "rosbag2/split"}) {
    const auto file = openMessageFile(formatFile(name));
    const std::vector<std::string> expected = test::listed(*file);
    std::vector<std::vector<std::string>> found(4);
    std::vector<std::thread> threads;
    for (auto& lines : found) threads.emplace_back([&] { lines = test::listed(*file); });
    for (std::thread& thread : threads) thread.join();
    for (const auto& lines : found) EXPECT_EQ(lines, expected) << name;
  }
}

// Every prefix of a recording is a recording that was not finished.
TEST(RecordedFilesCut, HaveTheMessagesOfTheWholeChunks) {
  const test::TemporaryDirectory directory;
  for (const char* const name : {"mcap/ros2_lz4.mcap", "mcap/no_chunks.mcap", "ros1_bag/lz4.bag"}) {
    const std::string whole = test::contentsOf(formatFile(name));
    const std::vector<std::string> all = test::listed(*openMessageFile(formatFile(name)));
    std::size_t before = 0;
    for (std::size_t size = 100; size + 8 < whole.size(); size += 37) {
      const fs::path path = directory.write("cut", whole.substr(0, size));
      if (size < 4200 && fs::path(name).extension() == ".bag") continue;  // in the header of the bag
      const auto file = openMessageFile(path);
      EXPECT_FALSE(file->warnings().empty()) << size;
      for (const std::string& line : test::listed(*file)) EXPECT_EQ(std::count(all.begin(), all.end(), line), 1);
      EXPECT_GE(file->messages().size(), before) << size;
      before = file->messages().size();
    }
    EXPECT_EQ(before, all.size()) << name;
  }
}

}  // namespace
}  // namespace gaussmap
