// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "gaussmap/io/mesh/ply.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"

namespace gaussmap {
namespace {

using test::bytesOf;

const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

/// 11 lines of header, three vertices, one face.
std::string header(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment x\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" + kFaces;
}
std::string asciiFile() {
  return header("ascii") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
}
std::string binaryFile() {
  std::string bytes = header("binary_little_endian");
  for (int i = 0; i < 9; ++i) bytes += bytesOf(static_cast<float>(i));
  return bytes + bytesOf(std::uint8_t{3}) + bytesOf(0) + bytesOf(1) + bytesOf(2);
}

std::string complaint(const std::filesystem::path& path) {
  return test::complaintOf([&] { readPly(path); });
}

class BadPlyFiles : public testing::Test {
 protected:
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces) const {
    const std::filesystem::path path = directory_.write("mesh.ply", bytes);
    test::expectComplaint(complaint(path), path, pieces);
  }
  /// A good file with a part replaced.
  void expectChangeRefused(std::string text, const std::string& part, const std::string& replacement,
                           const std::vector<std::string>& pieces) const {
    const std::size_t place = text.find(part);
    ASSERT_NE(place, std::string::npos) << part;
    expectRefused(text.replace(place, part.size(), replacement), pieces);
  }
  void expectRefused(const std::string& part, const std::string& replacement,
                     const std::vector<std::string>& pieces) const {
    expectChangeRefused(asciiFile(), part, replacement, pieces);
  }
  test::TemporaryDirectory directory_;
};

TEST_F(BadPlyFiles, TheGoodOnesAreRead) {
  EXPECT_EQ(complaint(directory_.write("a.ply", asciiFile())), "");
  EXPECT_EQ(complaint(directory_.write("b.ply", binaryFile())), "");
  EXPECT_EQ(complaint(directory_.write("c.ply", binaryFile() + "tail")), "");
}

TEST_F(BadPlyFiles, OtherKindsOfFilesAreRefusedInTheirFirstLine) {
  expectRefused("", {"empty"});
  expectRefused("once upon a time\n", {"line 1", "'once'", "PLY"});
  expectRefused("# .PCD v0.7\nVERSION 0.7\n", {"line 1"});
  expectRefused("\x89PNG\r\n\x1a\n", {"line 1", "'\\x89PNG'"});
  expectRefused(std::string(3 << 20, '\0'), {"line 1"});
  expectRefused("ply\n" + std::string(3 << 20, '\n'), {"no end_header in the first MiB"});
  std::filesystem::create_directory(directory_.path() / "folder.ply");
  ASSERT_EQ(mkfifo((directory_.path() / "pipe.ply").c_str(), 0600), 0);
  EXPECT_NE(complaint(directory_.path() / "folder.ply").find("directory"), std::string::npos);
  EXPECT_NE(complaint(directory_.path() / "pipe.ply").find("pipe"), std::string::npos);
  EXPECT_NE(complaint(directory_.path() / "none.ply").find("No such file"), std::string::npos);
}

TEST_F(BadPlyFiles, EveryTruncationIsRefused) {
  const std::string ascii = asciiFile(), binary = binaryFile();
  for (std::size_t size = 0; size + 2 < ascii.size(); ++size) expectRefused(ascii.substr(0, size), {});
  for (std::size_t size = 0; size < binary.size(); ++size) expectRefused(binary.substr(0, size), {});
  expectRefused(ascii.substr(0, ascii.find("0 1 0")), {"line 4", "'vertex'", "do not fit"});
  expectRefused(binary.substr(0, binary.size() - 1), {"byte ", "does not fit into the rest"});
}

TEST_F(BadPlyFiles, HeadersThatMakeNoSenseAreRefused) {
  expectRefused("format ascii 1.0", "format ascii 2.0", {"line 2", "ascii 1.0"});
  expectRefused("format ascii 1.0", "format text 1.0", {"line 2"});
  expectRefused("format ascii 1.0\n", "", {"no line 'format'"});
  expectRefused("comment x", "format ascii 1.0", {"line 3", "second line 'format'"});
  expectRefused("comment x", "property float x", {"line 3", "before any element"});
  expectRefused("comment x", "remark x", {"line 3", "'remark'"});
  expectRefused("element vertex 3", "element vertex", {"line 4", "element NAME COUNT"});
  expectRefused("element vertex 3", "element vertex -3", {"line 4", "'-3'"});
  expectRefused("element vertex 3", "element vertex 1e3", {"line 4", "'1e3'"});
  expectRefused("element vertex 3", "element vertex 99999999999999999999", {"line 4", "64 bits"});
  expectRefused("property float y", "property float x", {"line 6", "'x' occurs twice"});
  expectRefused("property float y", "property real y", {"line 6", "'real'"});
  expectRefused("property float y", "property float", {"line 6"});
  expectRefused("property list uchar int vertex_indices", "property list float int vertex_indices",
                {"line 9", "'float'"});
  expectRefused("element face 1", "element vertex 1", {"line 8", "second element 'vertex'"});
}

TEST_F(BadPlyFiles, WhatIsNoMeshIsRefused) {
  expectRefused("property float z", "property float w", {"'vertex'", "'z'"});
  expectRefused("property float z", "property list uchar float z", {"'z'"});
  expectRefused("element vertex", "element vertices", {"no element vertex"});
  expectRefused("element face", "element faces", {"no element face", "point cloud"});
  expectRefused("element face", "element tristrips", {"triangle strips"});
  expectRefused("vertex_indices", "corners", {"line 8", "vertex_indices"});
  expectRefused("uchar int vertex_indices", "uchar float vertex_indices", {"line 8", "whole numbers"});
  expectRefused("element face 1", "element face 0\nelement tail 5\nelement face 1", {"second element"});
  expectRefused("element face 1\n", "element tail 5\nelement face 1\n", {"'tail'", "no property"});
}

TEST_F(BadPlyFiles, NumbersThatLieAreRefusedBeforeMemoryIsTaken) {
  for (const std::string number : {"1000", "4000000000", "1000000000000000", "18446744073709551615"}) {
    expectRefused("element vertex 3", "element vertex " + number, {"line 4"});
    expectRefused("element face 1", "element face " + number, {"line 8", "do not fit"});
    expectChangeRefused(binaryFile(), "element vertex 3", "element vertex " + number, {"line 4"});
    expectChangeRefused(binaryFile(), "element face 1", "element face " + number, {"line 8", "do not fit"});
  }
  expectRefused("\n3 0 1 2", "\n250 0 1 2", {"line 14", "250 entries"});
  expectRefused("\n3 0 1 2", "\n7 0 1 2", {"line 14"});
  const std::string wide = "list uint int vertex_indices", narrow = "list uchar int vertex_indices";
  std::string huge = binaryFile();
  huge.replace(huge.find(narrow), narrow.size(), wide);
  huge = huge.substr(0, huge.size() - 13) + bytesOf(0xFFFFFFFFu) + std::string(12, '\0');
  expectRefused(huge, {"byte ", "4294967295 entries"});
}

TEST_F(BadPlyFiles, IndicesOutOfRangeAreRefused) {
  expectRefused("3 0 1 2", "3 0 1 3", {"line 14", "face 0", "vertex 3 of 3"});
  expectRefused("3 0 1 2", "3 -1 1 2", {"line 14", "vertex -1"});
  expectRefused("3 0 1 2", "3 0 1 4294967296", {"line 14"});
  expectRefused("3 0 1 2", "3 0 1 1.5", {"line 14", "'1.5'"});
  expectRefused("3 0 1 2", "2 0 1", {"line 14", "2 corners"});
  expectRefused("3 0 1 2", "0 0 0 0", {"line 14", "0 corners"});
  expectRefused("3 0 1 2", "-3 0 1 2", {"line 14", "-3"});
  std::string bytes = binaryFile();
  bytes[bytes.size() - 1] = '\x80';
  expectRefused(bytes, {"byte " + std::to_string(bytes.size() - 13), "vertex -2147483646 of 3"});
}

TEST_F(BadPlyFiles, VerticesThatAreNotFiniteAreRefused) {
  for (const std::string word : {"nan", "inf", "-inf", "1e300"})
    expectRefused("1 0 0", "1 " + word + " 0", {"line 12", word == "1e300" ? "1e70" : "vertex 1 is not finite"});
  std::string bytes = binaryFile();
  bytes.replace(bytes.size() - 13 - 4, 4, bytesOf(std::numeric_limits<float>::quiet_NaN()));
  expectRefused(bytes, {"byte ", "vertex 2 is not finite"});
}

TEST_F(BadPlyFiles, AsciiLinesWithOtherThanTheirValuesAreRefused) {
  expectRefused("1 0 0", "1 0", {"line 12", "ends before"});
  expectRefused("1 0 0", "1 0 0 0", {"line 12", "more values"});
  expectRefused("1 0 0", "1 0,5 0", {"line 12", "'0,5'"});
  expectRefused("1 0 0", "1 zero 0", {"line 12", "'zero'"});
  expectRefused("3 0 1 2\n", "3 0 1 2\n3 0 1 2\n", {"line 15", "more data"});
}

TEST_F(BadPlyFiles, EveryMutationIsReadOrRefused) {
  std::string big = binaryFile();
  big.replace(big.find("little"), 6, "big");
  test::expectMutationsReadOrRefused({asciiFile(), binaryFile(), big}, [&](const std::string& bytes) {
    checkMesh(readPly(directory_.write("mesh.ply", bytes)));
  });
}

}  // namespace
}  // namespace gaussmap
