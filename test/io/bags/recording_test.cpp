// SPDX-License-Identifier: BSD-3-Clause
#include "io/bags/recording.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zstd.h>

#include "io/bags/bag_bytes.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

std::string recordingOf(const std::string& topic, std::uint64_t time, const std::string& data) {
  namespace mcap = test::mcap;
  return mcap::file(mcap::schema(1, "A") + mcap::channel(1, 1, topic) + mcap::message(1, time, data));
}

std::string zstdFile(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  return packed;
}

std::string metadataOf(const std::vector<std::string>& names) {
  std::string text = "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n";
  for (const std::string& name : names) text += "    - " + name + "\n";
  return text;
}

class RecordingFolders : public testing::Test {
 protected:
  const fs::path& path() const { return directory_.path(); }
  void expectRefused(const fs::path& refused, const std::vector<std::string>& pieces) const {
    test::expectComplaint(test::complaintOf([&] { test::texts(refused); }), refused, pieces);
  }
  void expectWarning(const std::string& piece) const {
    const std::string found = test::warningsOf(path());
    EXPECT_NE(found.find(piece), std::string::npos) << piece << " in: " << found;
  }
  test::TemporaryDirectory directory_;
};

TEST_F(RecordingFolders, JoinTheFilesOfTheMetadata) {
  directory_.write("bag_2.mcap", recordingOf("/a", 10, "first"));
  directory_.write("bag_10.mcap", recordingOf("/a", 10, "second"));
  directory_.write("bag_11.mcap", recordingOf("/b", 5, "third"));
  directory_.write("metadata.yaml", metadataOf({"bag_2.mcap", "bag_10.mcap", "bag/bag_11.mcap"}));
  EXPECT_TRUE(detail::isMessageFile(path()));
  EXPECT_EQ(test::texts(path()), (Lines{"/b 5 third", "/a 10 first", "/a 10 second"}));
  EXPECT_EQ(test::warningsOf(path()), "");
  const auto file = detail::openMessageFile(path());
  EXPECT_EQ(file->kind(), "3 files: MCAP");
  ASSERT_EQ(file->topics().size(), 2u);
  EXPECT_EQ(file->topics()[0].messages, 2u);
}

TEST_F(RecordingFolders, HaveTheirFilesInTheOrderOfTheNumbers) {
  const Lines names = {"rec_0.mcap", "rec_1.mcap.zstd", "rec_2.mcap", "rec_10.mcap"};
  for (const std::string& name : names) directory_.write(name, "");
  Lines found;
  for (const fs::path& file : detail::findRecordingFiles(path()).files) found.push_back(file.filename().string());
  EXPECT_EQ(found, names);
}

TEST_F(RecordingFolders, ReportMissingAndOtherFiles) {
  directory_.write("bag_0.mcap", recordingOf("/a", 1, "x"));
  directory_.write("copy.mcap", recordingOf("/a", 2, "y"));
  directory_.write("metadata.yaml", metadataOf({"'bag_0.mcap'", "\"bag_1.mcap\""}));
  EXPECT_EQ(test::texts(path()), Lines{"/a 1 x"});
  expectWarning("copy.mcap is not read, because metadata.yaml does not name it");
  expectWarning("bag_1.mcap is missing, but metadata.yaml names it");
  directory_.write("metadata.yaml", metadataOf({"renamed.mcap"}));
  EXPECT_EQ(test::texts(path()), (Lines{"/a 1 x", "/a 2 y"}));
  expectWarning("metadata.yaml does not name the files of this folder");
}

TEST_F(RecordingFolders, NeedNoMetadataIfNothingElseIsThere) {
  EXPECT_FALSE(detail::isMessageFile(path()));
  expectRefused(path(), {"the folder has no recording (.mcap, .db3"});
  directory_.write("a.mcap", recordingOf("/a", 1, "x"));
  directory_.write("b.mcap", "");
  EXPECT_TRUE(detail::isMessageFile(path()));
  EXPECT_EQ(test::texts(path()), Lines{"/a 1 x"});
  expectWarning("no metadata.yaml of rosbag2: its 2 files are read as one recording");
  expectWarning("b.mcap is empty");
  directory_.write("scan.pcd", "x");
  EXPECT_FALSE(detail::isMessageFile(path()));
  directory_.write("metadata.yaml", metadataOf({"a.mcap"}));
  EXPECT_TRUE(detail::isMessageFile(path()));
}

TEST_F(RecordingFolders, ExpandCompressedFiles) {
  directory_.write("bag_0.mcap.zstd", zstdFile(recordingOf("/a", 1, "x")));
  directory_.write("bag_1.mcap.zstd", zstdFile(recordingOf("/a", 2, "y")));
  directory_.write("metadata.yaml", metadataOf({"bag_0.mcap.zstd", "bag_1.mcap.zstd"}));
  EXPECT_TRUE(detail::isMessageFile(path()));
  EXPECT_TRUE(detail::isMessageFile(path() / "bag_0.mcap.zstd"));
  EXPECT_EQ(test::texts(path()), (Lines{"/a 1 x", "/a 2 y"}));
  EXPECT_EQ(test::warningsOf(path()), "");
  // ros2 bag play leaves an expanded file beside the compressed one
  directory_.write("bag_0.mcap", recordingOf("/a", 1, "x"));
  EXPECT_EQ(test::texts(path()), (Lines{"/a 1 x", "/a 2 y"}));
  expectWarning("bag_0.mcap.zstd is not read, because bag_0.mcap is there, too");
}

TEST_F(RecordingFolders, RefuseDamagedCompressedFiles) {
  const std::string packed = zstdFile(recordingOf("/a", 1, "x"));
  expectRefused(directory_.write("a.mcap.zstd", packed.substr(0, packed.size() - 3)),
                {"the zstd file is damaged: it ends too early"});
  expectRefused(directory_.write("b.mcap.zstd", packed + "tail"), {"the zstd file is damaged"});
  expectRefused(directory_.write("c.mcap.zstd", zstdFile("text")), {"is not a recording: it starts with 'text'"});
  EXPECT_FALSE(detail::isMessageFile(path() / "c.mcap.zstd"));
  std::string bad = recordingOf("/a", 1, "x");
  bad[8] = 5;
  expectRefused(directory_.write("d.mcap.zstd", zstdFile(bad)), {"expected a Header record"});
  expectRefused(directory_.write("e.db3.zstd", zstdFile("SQLite format 3" + std::string(200, '\0'))), {"damaged"});
}

TEST_F(RecordingFolders, RefuseOtherFiles) {
  expectRefused(directory_.write("a.mcap", ""), {"the file is empty"});
  expectRefused(directory_.write("b.mcap", "once upon a time"),
                {"is not a recording: it starts with 'once upon a time'"});
  ASSERT_EQ(mkfifo((path() / "pipe.mcap").c_str(), 0600), 0);
  expectRefused(path() / "pipe.mcap", {"pipe"});
  EXPECT_FALSE(detail::isMessageFile(path() / "pipe.mcap"));
  expectRefused(path() / "none.mcap", {"No such file"});
}

}  // namespace
}  // namespace gaussmap
