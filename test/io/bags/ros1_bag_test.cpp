// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/ros1_bag.h"

#include <bzlib.h>
#include <gtest/gtest.h>

#include "io/bags/bag_bytes.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

namespace ros1 = test::ros1;
using Lines = std::vector<std::string>;

std::string bz2(std::string bytes) {
  std::string packed(bytes.size() + bytes.size() / 100 + 600, '\0');
  auto size = static_cast<unsigned int>(packed.size());
  BZ2_bzBuffToBuffCompress(packed.data(), &size, bytes.data(), static_cast<unsigned int>(bytes.size()), 1, 0, 0);
  return packed.substr(0, size);
}

const std::string kConnection = ros1::connection(3, "/a", "a_msgs/A");

/// Returns a finished bag. The summary describes `chunks` chunks.
std::string bag(const std::string& data, const std::string& summary = "", std::uint32_t chunks = 0) {
  const std::size_t begin = ros1::kMagic.size() + ros1::bagHeader(0, 1, chunks).size();
  return ros1::kMagic + ros1::bagHeader(begin + data.size(), 1, chunks) + data + summary;
}
std::string unfinished(const std::string& data) {
  return ros1::kMagic + ros1::bagHeader(0, 0, 0) + data;
}

class Ros1Bags : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& bytes) const { return directory_.write("a.bag", bytes); }
  Lines texts(const std::string& bytes) const { return test::texts(write(bytes)); }
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces) const {
    const std::filesystem::path path = write(bytes);
    test::expectComplaint(test::complaintOf([&] { test::texts(path); }), path, pieces);
  }
  void expectWarning(const std::string& bytes, const std::string& piece) const {
    const std::string found = test::warningsOf(write(bytes));
    EXPECT_NE(found.find(piece), std::string::npos) << piece << " in: " << found;
  }
  test::TemporaryDirectory directory_;
};

TEST_F(Ros1Bags, UseTheIndex) {
  const std::string chunk =
      kConnection + ros1::message(3, ros1::time(7, 5), "late") + ros1::message(3, ros1::time(6, 0), "");
  const auto first = static_cast<std::uint32_t>(kConnection.size());
  const auto second = first + static_cast<std::uint32_t>(ros1::message(3, 0, "late").size());
  const std::string file = bag(ros1::chunk(bz2(chunk), "bz2", static_cast<std::uint32_t>(chunk.size())) +
                                   ros1::index(3, {{ros1::time(7, 5), first}, {ros1::time(6, 0), second}}),
                               kConnection + ros1::chunkInfo(0, 3, 2), 1);
  EXPECT_EQ(texts(file), (Lines{"/a 6000000000 ", "/a 7000000005 late"}));
  EXPECT_EQ(test::warningsOf(write(file)), "");
}

TEST_F(Ros1Bags, ReadTheChunksIfTheIndexIsDamagedOrTooShort) {
  const std::string chunk =
      kConnection + ros1::message(3, ros1::time(1, 0), "x") + ros1::message(3, ros1::time(2, 0), "y");
  const auto first = static_cast<std::uint32_t>(kConnection.size());
  const Lines both{"/a 1000000000 x", "/a 2000000000 y"};
  for (const std::string& index :
       {ros1::index(3, {{ros1::time(1, 0), first}}), ros1::index(3, {{ros1::time(1, 0), 1u << 30}}),
        ros1::index(3, {{ros1::time(1, 0), first}}, 9), ros1::record(4, "", "12345")}) {
    const std::string file = bag(ros1::chunk(chunk) + index, kConnection + ros1::chunkInfo(0, 3, 2), 1);
    EXPECT_EQ(texts(file), both);
  }
  expectWarning(
      bag(ros1::chunk(chunk) + ros1::index(3, {{ros1::time(1, 0), first}}), kConnection + ros1::chunkInfo(0, 3, 2), 1),
      "the index has 1 messages, but the chunks have 2");
  expectWarning(bag(ros1::chunk(chunk), kConnection, 1), "announces 1 chunks, but it has 1 and describes 0");
}

TEST_F(Ros1Bags, AreReadWithoutIndex) {
  const std::string chunk = kConnection + ros1::message(3, ros1::time(1, 0), "x");
  const std::string second = ros1::message(3, ros1::time(2, 0), "y");
  const std::string file = unfinished(ros1::chunk(chunk) + ros1::chunk(second));
  EXPECT_EQ(texts(file), (Lines{"/a 1000000000 x", "/a 2000000000 y"}));
  expectWarning(file, "was not finished, the bag has no index");
  const std::string cut = file.substr(0, file.size() - 5);
  EXPECT_EQ(texts(cut), Lines{"/a 1000000000 x"});
  expectWarning(cut, "it ends in the middle of a chunk at byte ");
  // The chunk that the recorder was writing has no size yet.
  EXPECT_EQ(texts(unfinished(ros1::chunk("", "none", 0) + chunk + second)),
            (Lines{"/a 1000000000 x", "/a 2000000000 y"}));
  expectWarning(bag(ros1::chunk(chunk)).substr(0, 200), "was cut off");
}

TEST_F(Ros1Bags, RefuseMessagesThatAreNotWhereTheIndexSays) {
  const std::string chunk = kConnection + ros1::message(3, ros1::time(1, 0), "x");
  expectRefused(
      bag(ros1::chunk(chunk) + ros1::index(3, {{ros1::time(1, 0), 0}}), kConnection + ros1::chunkInfo(0, 3, 1), 1),
      {"byte 0 of the chunk at byte", "expected a message (op 2)"});
  const auto first = static_cast<std::uint32_t>(kConnection.size());
  expectRefused(
      bag(ros1::chunk(chunk) + ros1::index(3, {{ros1::time(9, 0), first}}), kConnection + ros1::chunkInfo(0, 3, 1), 1),
      {"another message"});
}

TEST_F(Ros1Bags, RefuseOtherFiles) {
  expectRefused("", {"empty"});
  expectRefused("#ROSBAG V1.2\nmore", {"starts with '#ROSBAG V1.2'", "only version 2.0", "rosbag fix"});
  expectRefused(ros1::kMagic + kConnection, {"byte 13", "expected the header of the bag (op 3), found op 7"});
  expectRefused(ros1::kMagic + ros1::record(3, "", ""), {"no fields index_pos and chunk_count"});
  expectRefused(ros1::kMagic + ros1::bagHeader(0, 0, 0, ros1::field("encryptor", "rosbag/AesCbcEncryptor")),
                {"encrypted with 'rosbag/AesCbcEncryptor'", "rosbag decrypt"});
  expectRefused(bag(ros1::chunk("x", "xz", 5)), {"compressed with 'xz'", "rosbag decompress"});
  expectRefused(bag(ros1::record(5, "", "")), {"no fields size and compression"});
  expectRefused(bag(ros1::record(7, "", "")), {"connection has no fields conn and topic"});
  expectRefused(bag(ros1::record(7, ros1::number("conn", 3) + ros1::field("topic", "/a"), "")),
                {"connection 3 has no field type"});
  expectRefused(bag(ros1::record(2, "", "")), {"message has no fields conn and time"});
}

TEST_F(Ros1Bags, RefuseDamagedChunksAndBombs) {
  expectRefused(bag(ros1::chunk(bz2("x"), "bz2", 5)), {"(bz2) does not expand to the 5 bytes"});
  expectRefused(bag(ros1::chunk(bz2("xxxxxxxx"), "bz2", 5)), {"(bz2) does not expand to the 5 bytes"});
  expectRefused(bag(ros1::chunk("BZh9", "bz2", 5)), {"(bz2) is damaged"});
  expectRefused(bag(ros1::chunk("text", "lz4", 5)), {"(lz4) is damaged"});
  expectRefused(bag(ros1::chunk("x", "lz4", 1u << 30)), {"claims to expand to 1073741824 bytes"});
  expectRefused(bag(ros1::chunk("xyz", "none", 2)), {"both must be equal"});
  expectRefused(bag(ros1::chunk("xyz")), {"byte 0 of the chunk", "reaches beyond the end of the chunk"});
  expectRefused(bag(ros1::chunk(ros1::chunk(""))), {"expected a message (op 2) or a connection (op 7), found op 5"});
  expectRefused(bag(kConnection + ros1::connection(3, "/b", "B")), {"channel 3 is '/a'", "and also '/b'"});
}

TEST_F(Ros1Bags, MutationsAreReadOrRefused) {
  const std::string chunk =
      kConnection + ros1::message(3, ros1::time(1, 0), "x") + ros1::message(3, ros1::time(2, 0), "y");
  const auto first = static_cast<std::uint32_t>(kConnection.size());
  const std::string indexed =
      bag(ros1::chunk(chunk) + ros1::index(3, {{ros1::time(1, 0), first}}), kConnection + ros1::chunkInfo(0, 3, 2), 1);
  const std::string packed = unfinished(ros1::chunk(bz2(chunk), "bz2", static_cast<std::uint32_t>(chunk.size())));
  test::expectMutationsReadOrRefused({indexed, packed}, [&](const std::string& bytes) {
    texts(bytes);
    if (!test::warningsOf(directory_.path() / "a.bag").empty()) throw FileError("a.bag", "has warnings");
  });
}

}  // namespace
}  // namespace gaussmap
