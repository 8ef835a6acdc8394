// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/mcap_file.h"

#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include "io/bags/bag_bytes.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

namespace mcap = test::mcap;
using Lines = std::vector<std::string>;

std::string zstd(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  return packed;
}

std::string lz4(const std::string& bytes, const LZ4F_preferences_t& options) {
  std::string packed(LZ4F_compressFrameBound(bytes.size(), &options), '\0');
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), &options));
  return packed;
}

const std::string kDefinitions = mcap::schema(1, "a_msgs/msg/A") + mcap::channel(1, 1, "/a");

class McapFiles : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& bytes) const { return directory_.write("a.mcap", bytes); }
  Lines texts(const std::string& bytes) const { return test::texts(write(bytes)); }
  std::string warnings(const std::string& bytes) const { return test::warningsOf(write(bytes)); }
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces) const {
    const std::filesystem::path path = write(bytes);
    test::expectComplaint(test::complaintOf([&] { test::texts(path); }), path, pieces);
  }
  void expectWarning(const std::string& bytes, const std::string& piece) const {
    const std::string found = warnings(bytes);
    EXPECT_NE(found.find(piece), std::string::npos) << piece << " in: " << found;
  }
  test::TemporaryDirectory directory_;
};

TEST_F(McapFiles, AreReadWithoutChunksInTheOrderOfTheTimes) {
  const std::string data = kDefinitions + mcap::message(1, 30, "x") + mcap::message(1, 10, "y") +
                           mcap::message(1, 30, "z") + mcap::message(1, 20, "");
  EXPECT_EQ(texts(mcap::file(data)), (Lines{"/a 10 y", "/a 20 ", "/a 30 x", "/a 30 z"}));
  EXPECT_EQ(warnings(mcap::file(data)), "");
}

TEST_F(McapFiles, UseTheIndexOfAChunkAndTheSummary) {
  const std::string chunk = mcap::message(1, 5, "five") + mcap::message(1, 4, "four");
  const std::uint64_t second = mcap::message(1, 5, "five").size();
  const std::string file = mcap::file(
      mcap::chunk(zstd(chunk), "zstd", chunk.size(), test::crcOf(chunk)) + mcap::index(1, {{5, 0}, {4, second}}),
      kDefinitions + mcap::statistics(2));
  EXPECT_EQ(texts(file), (Lines{"/a 4 four", "/a 5 five"}));
  EXPECT_EQ(warnings(file), "");
}

TEST_F(McapFiles, ReadTheChunksIfTheIndexHasTooFewMessages) {
  const std::string chunk = kDefinitions + mcap::message(1, 5, "five") + mcap::message(1, 4, "four");
  const std::string file =
      mcap::file(mcap::chunk(chunk) + mcap::index(1, {{5, kDefinitions.size()}}), kDefinitions + mcap::statistics(2));
  EXPECT_EQ(texts(file), (Lines{"/a 4 four", "/a 5 five"}));
  expectWarning(file, "the index has 1 messages, but the chunks have 2");
}

TEST_F(McapFiles, IgnoreDamagedIndexRecordsAndDoubleEntries) {
  const std::string chunk = kDefinitions + mcap::message(1, 5, "five");
  const std::uint64_t place = kDefinitions.size();
  for (const std::string& index :
       {mcap::index(1, {{5, place}, {5, place}}), mcap::index(1, {{5, place}, {9, 1u << 20}}), mcap::record(7, "\1"),
        mcap::record(7, test::bytesOf(std::uint16_t{1}) + test::counted("12345"))})
    EXPECT_EQ(texts(mcap::file(mcap::chunk(chunk) + index)), Lines{"/a 5 five"});
}

TEST_F(McapFiles, RefuseMessagesThatAreNotWhereTheIndexSays) {
  const std::string chunk = kDefinitions + mcap::message(1, 5, "five");
  const std::uint64_t place = kDefinitions.size();
  expectRefused(mcap::file(mcap::chunk(chunk) + mcap::index(1, {{5, place + 1}}), kDefinitions),
                {"byte " + std::to_string(place + 1) + " of the chunk at byte", "expected a Message record"});
  expectRefused(mcap::file(mcap::chunk(chunk) + mcap::index(1, {{6, place}}), kDefinitions), {"another message"});
}

TEST_F(McapFiles, FindDefinitionsInEarlierChunks) {
  const std::string first =
      mcap::schema(1, "A") + mcap::channel(1, 1, "/a") + mcap::message(1, 1, "x") + mcap::schema(2, "B");
  const std::string second = mcap::channel(2, 2, "/b") + mcap::message(2, 2, "y");
  const std::string bytes = mcap::kMagic + mcap::header() + mcap::chunk(first) +
                            mcap::index(1, {{1, mcap::schema(1, "A").size() + mcap::channel(1, 1, "/a").size()}}) +
                            mcap::chunk(second) + mcap::index(2, {{2, mcap::channel(2, 2, "/b").size()}});
  EXPECT_EQ(texts(bytes), (Lines{"/a 1 x", "/b 2 y"}));
  expectWarning(bytes, "the recording was not finished: it ends at byte");
  expectWarning(bytes + mcap::chunk(second).substr(0, 60), "in the middle of a chunk at byte");
  expectWarning(bytes + std::string(4096, '\0'), "bytes that are not a record");
}

TEST_F(McapFiles, WarnAboutDamagedSummariesAndTrailingBytes) {
  std::string file = mcap::file(kDefinitions + mcap::message(1, 1, "x"), mcap::statistics(7));
  expectWarning(file, "counts 7 messages, but 1 were found");
  expectWarning(file + "more", "4 more bytes follow");
  file[file.size() - 60] ^= 1;
  expectWarning(file, "summary at the end is damaged");
  EXPECT_EQ(texts(file), Lines{"/a 1 x"});
  expectWarning(mcap::file(kDefinitions + mcap::message(1, 1, "x"), "", 77), "CRC of its messages is wrong");
}

TEST_F(McapFiles, SkipDamagedChunksUnlessAllAreDamaged) {
  const std::string good = mcap::chunk(kDefinitions + mcap::message(1, 1, "x"));
  const std::string cut = mcap::chunk(mcap::message(1, 2, "y") + mcap::message(1, 3, "z").substr(0, 20));
  const std::string wrong_crc = mcap::chunk(mcap::message(1, 4, "w"), "", ~0ull, 17);
  const std::string wrong_size = mcap::chunk(zstd(mcap::message(1, 5, "v")), "zstd", 3);
  const std::string file = mcap::file(good + cut + wrong_crc + wrong_size);
  EXPECT_EQ(texts(file), (Lines{"/a 1 x", "/a 2 y"}));
  expectWarning(file, "messages are missing because 3 chunks are damaged, the first one: byte 32 of the chunk at byte");
  expectRefused(mcap::file(wrong_crc), {"CRC is wrong"});
  expectRefused(mcap::file(wrong_size), {"(zstd) is damaged: Destination buffer"});
  expectRefused(mcap::file(mcap::chunk("no frame", "lz4", 100)), {"(lz4) is damaged"});
}

TEST_F(McapFiles, RefuseOtherFilesAndCompressions) {
  expectRefused("", {"empty"});
  expectRefused("\x89MCAP1\r\n", {"it starts with '\\x89MCAP1"});
  expectRefused(mcap::kMagic + mcap::message(1, 1, ""), {"byte 8", "expected a Header record (kind 1), found kind 5"});
  expectRefused(mcap::file(mcap::chunk("x", "br", 5)), {"compressed with 'br'", "mcap compress"});
  expectRefused(mcap::file(mcap::record(6, "short")), {"Chunk record is too short"});
  expectRefused(mcap::file(mcap::record(4, "short")), {"Channel record is too short"});
  expectRefused(mcap::file(mcap::channel(3, 9, "/a")), {"channel 3 has schema 9, which is not defined"});
}

TEST_F(McapFiles, RefuseNumbersWithTwoMeanings) {
  expectRefused(mcap::file(kDefinitions + mcap::channel(1, 1, "/b")), {"channel 1 is '/a'", "and also '/b'"});
  expectRefused(mcap::file(kDefinitions + mcap::schema(1, "B")), {"schema 1 is 'a_msgs/msg/A' and also 'B'"});
  expectRefused(mcap::file(mcap::schema(0, "B")), {"number 0"});
  EXPECT_EQ(texts(mcap::file(kDefinitions + kDefinitions + mcap::message(1, 1, "x"))), Lines{"/a 1 x"});
}

TEST_F(McapFiles, IgnoreMessagesOfUnknownChannels) {
  const std::string file = mcap::file(kDefinitions + mcap::message(1, 1, "x") + mcap::message(9, 2, "y"));
  EXPECT_EQ(texts(file), Lines{"/a 1 x"});
  expectWarning(file, "1 messages are ignored, because their channel is not defined");
}

TEST_F(McapFiles, RefuseImplausibleSizes) {
  constexpr std::uint64_t kGigabyte = std::uint64_t{1} << 30;
  expectRefused(mcap::file(mcap::chunk("x", "zstd", kGigabyte)),
                {"chunk of 1 bytes (zstd) claims to expand to 1073741824"});
  expectRefused(mcap::file(mcap::chunk("x", "zstd", ~0ull - 1)), {"claims to expand"});
  expectRefused(mcap::file(mcap::chunk("x", "", 2)), {"without compression both must be equal"});
  std::string many;
  for (int i = 0; i < 40; ++i) many += mcap::chunk("x", "zstd", kGigabyte / 32);
  expectRefused(mcap::file(many), {"all chunks together"});
  std::string far = mcap::record(6, "");
  far.replace(1, 8, 8, '\xFF');
  expectWarning(mcap::kMagic + mcap::header() + far, "in the middle of a chunk at byte 33");
}

TEST_F(McapFiles, LimitTheNumberOfMessagesOfABomb) {
  std::string block;
  for (int i = 0; i < 100000; ++i) block += mcap::message(1, 1, "");
  const std::string packed = zstd(block);
  std::string data = kDefinitions;
  for (int i = 0; i < 12; ++i) data += mcap::chunk(packed, "zstd", block.size());
  const auto file = detail::openMessageFile(write(mcap::file(data)));
  EXPECT_LE(file->messages().size(), 1000000 + data.size() + 200);
  EXPECT_NE(test::warningsOf(directory_.path() / "a.mcap").find("messages: it is damaged"), std::string::npos);
}

// Two chunks of 40 MiB do not fit into the smallest cache. Without a larger one, each message would expand a chunk.
TEST_F(McapFiles, KeepChunksWhoseMessagesAreInterleaved) {
  std::string data = kDefinitions;
  for (std::uint64_t parity = 0; parity < 2; ++parity) {
    std::string chunk = mcap::record(0x80, std::string(std::size_t{40} << 20, '\0'));
    for (std::uint64_t i = 0; i < 1000; ++i) chunk += mcap::message(1, 2 * i + parity, std::to_string(parity));
    data += mcap::chunk(zstd(chunk), "zstd", chunk.size());
  }
  const Lines found = texts(mcap::file(data));
  ASSERT_EQ(found.size(), 2000u);
  EXPECT_EQ(found[0], "/a 0 0");
  EXPECT_EQ(found[1999], "/a 1999 1");
}

// The start of a large message needs neither the whole chunk nor its CRC.
TEST_F(McapFiles, ReadTheStartsOfMessages) {
  std::string large(300000, '\0');
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<char>(i * i >> 7);
  const std::string small = mcap::message(1, 1, "small"), chunk = small + mcap::message(1, 2, large);
  const std::string index = mcap::index(1, {{1, 0}, {2, small.size()}});
  LZ4F_preferences_t lz4_options{};
  for (const LZ4F_blockSizeID_t block : {LZ4F_max64KB, LZ4F_max4MB}) {
    lz4_options.frameInfo.blockSizeID = block;
    for (const std::string& compression : {std::string("zstd"), std::string("lz4"), std::string()}) {
      const std::string packed = compression == "zstd"  ? zstd(chunk)
                                 : compression == "lz4" ? lz4(chunk, lz4_options)
                                                        : chunk;
      const auto bytes = [&](std::uint32_t crc) {
        return mcap::file(mcap::chunk(packed, compression, chunk.size(), crc) + index, kDefinitions);
      };
      test::expectStarts(*detail::openMessageFile(write(bytes(test::crcOf(chunk)))));
      const auto damaged = detail::openMessageFile(write(bytes(1)));
      const detail::MessageStart start = damaged->readStart(damaged->messages().at(1), 1000);
      EXPECT_EQ(start.size, large.size());
      EXPECT_EQ(test::textOf(start.bytes), large.substr(0, 1000));
      EXPECT_NE(test::complaintOf([&] { damaged->read(damaged->messages().at(1)); }).find("CRC"), std::string::npos);
    }
  }
}

TEST_F(McapFiles, ExpandCompressedMessages) {
  const std::string text = std::string("\0\1\0\0", 4) + std::string(100, 'x');
  EXPECT_EQ(texts(mcap::file(kDefinitions + mcap::message(1, 1, zstd(text)))), Lines{"/a 1 " + text});
  const std::string bomb = std::string("\x28\xB5\x2F\xFD\xE0", 5) + std::string(8, '\x11');  // claims 10^18 bytes
  expectRefused(mcap::file(kDefinitions + mcap::message(1, 1, bomb)),
                {"the compressed message has 13 bytes and claims"});
  const std::string json = mcap::channel(1, 0, "/a", "json");
  EXPECT_EQ(texts(mcap::file(json + mcap::message(1, 1, bomb))), Lines{"/a 1 " + bomb});
}

TEST_F(McapFiles, LargeTimesAreTheLastTime) {
  EXPECT_EQ(texts(mcap::file(kDefinitions + mcap::message(1, ~0ull, "x"))), Lines{"/a 9223372036854775807 x"});
}

TEST_F(McapFiles, MutationsAreReadOrRefused) {
  const std::string chunk = kDefinitions + mcap::message(1, 5, "five") + mcap::message(1, 4, "four");
  const std::uint64_t first = kDefinitions.size();
  const std::string indexed =
      mcap::file(mcap::chunk(chunk) + mcap::index(1, {{5, first}}), kDefinitions + mcap::statistics(2));
  const std::string packed = mcap::file(mcap::chunk(zstd(chunk), "zstd", chunk.size(), test::crcOf(chunk)));
  test::expectMutationsReadOrRefused({indexed, packed, mcap::file(chunk)}, [&](const std::string& bytes) {
    texts(bytes);
    if (!test::warningsOf(directory_.path() / "a.mcap").empty()) throw FileError("a.mcap", "has warnings");
  });
}

}  // namespace
}  // namespace gaussmap
