// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"

namespace gaussmap {
namespace {

using test::bytesOf;
using test::compressedBody;
using test::readAll;
using test::TemporaryDirectory;
using test::xyzHeader;

/// What the reader says of a file, "" if it reads it to the end.
std::string complaint(const std::filesystem::path& path) {
  return test::complaintOf([&] { readAll(PcdReader(path)); });
}

class BadPcdFiles : public testing::Test {
 protected:
  /// Expects an error that names the file and contains every piece.
  void expectRefused(const std::string& bytes, const std::vector<std::string>& pieces) const {
    const std::filesystem::path path = directory_.write("scan.pcd", bytes);
    test::expectComplaint(complaint(path), path, pieces);
  }
  /// The same for a header of one ascii point with one of its lines replaced.
  void expectHeaderRefused(const std::string& line, const std::string& replacement,
                           const std::vector<std::string>& pieces) const {
    std::string text = xyzHeader(1, "ascii") + "1 2 3\n";
    const std::size_t place = text.find(line);
    ASSERT_NE(place, std::string::npos);
    expectRefused(text.replace(place, line.size(), replacement), pieces);
  }
  TemporaryDirectory directory_;
};

TEST_F(BadPcdFiles, AnEmptyFileIsRefused) {
  expectRefused("", {"empty"});
}

TEST_F(BadPcdFiles, EveryTruncatedHeaderIsRefused) {
  const std::string header = xyzHeader(1, "binary");
  for (std::size_t size = 0; size < header.size(); ++size) expectRefused(header.substr(0, size), {});
  expectRefused("VERSION 0.7\nFIELDS x y z\n", {"DATA"});
}

TEST_F(BadPcdFiles, OtherKindsOfFilesAreRefusedInTheirFirstLine) {
  expectRefused("once upon a time\n", {"line 1", "'once'", "PCD"});
  expectRefused("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", {"line 1", "'\\x89PNG'"});
  expectRefused("\xEF\xBB\xBF" + xyzHeader(1, "ascii") + "1 2 3\n", {"line 1", "byte order mark", "without it"});
  expectRefused("ply\nformat ascii 1.0\n", {"line 1"});
  expectRefused(std::string(3 << 20, '\0'), {"line 1"});
  expectRefused(std::string(3 << 20, '\n'), {"no DATA line in the first MiB"});
  expectRefused("# " + std::string(3 << 20, 'x'), {"no DATA line in the first MiB"});
}

TEST_F(BadPcdFiles, RandomBytesAreRefused) {
  Random random(11);
  for (int round = 0; round < 200; ++round) {
    std::string bytes(random.below(2000), '\0');
    for (char& byte : bytes) byte = static_cast<char>(random.below(256));
    expectRefused(bytes, {});
  }
}

TEST_F(BadPcdFiles, WhatIsNoRegularFileIsRefusedAtOnce) {
  const std::filesystem::path folder = directory_.path() / "folder.pcd", pipe = directory_.path() / "pipe.pcd";
  std::filesystem::create_directory(folder);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(complaint(folder).find("directory"), std::string::npos);
  EXPECT_NE(complaint(pipe).find("pipe"), std::string::npos);
  EXPECT_NE(complaint("/dev/zero").find("device"), std::string::npos);
  EXPECT_NE(complaint(directory_.path() / "none.pcd").find("No such file"), std::string::npos);
}

TEST_F(BadPcdFiles, AnUnreadableFileIsRefused) {
  const std::filesystem::path path = directory_.write("scan.pcd", xyzHeader(0, "ascii"));
  std::filesystem::permissions(path, std::filesystem::perms::none);
  if (access(path.c_str(), R_OK) == 0) GTEST_SKIP() << "this user may read everything";
  EXPECT_NE(complaint(path).find("denied"), std::string::npos);
}

TEST_F(BadPcdFiles, FieldsThatAMapCannotUseAreRefused) {
  expectHeaderRefused("FIELDS x y z", "FIELDS x y w", {"line 3", "'z'"});
  expectHeaderRefused("FIELDS x y z", "FIELDS X Y W", {"line 3", "'z'"});
  expectHeaderRefused("FIELDS x y z", "FIELDS X y z", {"line 3", "'x'"});
  expectHeaderRefused("FIELDS x y z", "FIELDS X Y Y", {"line 3", "'y' occurs twice"});
  expectHeaderRefused("FIELDS x y z", "FIELDS x y y", {"line 3", "'y' occurs twice"});
  expectHeaderRefused("FIELDS x y z", "FIELDS", {"line 4", "0 FIELDS"});
  expectHeaderRefused("FIELDS x y z\n", "", {"no line FIELDS"});
  expectHeaderRefused("TYPE F F F", "TYPE I F F", {"line 5", "x is TYPE I", "metres"});
  expectHeaderRefused("SIZE 4 4 4", "SIZE 4 2 4", {"line 4", "y is TYPE F SIZE 2", "F 4 or F 8"});
  expectHeaderRefused("COUNT 1 1 1", "COUNT 1 1 2", {"line 6", "z has COUNT 2"});
}

TEST_F(BadPcdFiles, LinesThatDoNotFitEachOtherAreRefused) {
  expectHeaderRefused("SIZE 4 4 4", "SIZE 4 4", {"line 4", "2 entries for 3"});
  expectHeaderRefused("SIZE 4 4 4", "SIZE 4 4 0", {"line 4", "SIZE of field 'z' is 0"});
  expectHeaderRefused("SIZE 4 4 4\n", "", {"no line SIZE"});
  expectHeaderRefused("TYPE F F F", "TYPE F F", {"line 5", "2 entries for 3"});
  expectHeaderRefused("TYPE F F F", "TYPE F F D", {"line 5", "'D'"});
  expectHeaderRefused("TYPE F F F\n", "", {"no line TYPE"});
  expectHeaderRefused("COUNT 1 1 1", "COUNT 1", {"line 6", "1 entries for 3"});
  expectHeaderRefused("COUNT 1 1 1", "COUNT 1 1 0", {"line 6", "z has COUNT 0 instead of 1"});
  expectHeaderRefused("POINTS 1", "POINTS 2", {"line 10", "POINTS is 2"});
  expectHeaderRefused("POINTS 1", "POINTS 1\nPOINTS 1", {"line 11", "second line POINTS"});
  expectHeaderRefused("VERSION 0.7", "VERSION 0.8", {"line 2", "'0.8'"});
  expectHeaderRefused("DATA ascii", "DATA zip", {"line 11", "ascii, binary or binary_compressed"});
  expectHeaderRefused("DATA ascii", "DATA", {"line 11"});
  expectRefused("FIELDS x y z\nDATA ascii\n1 2 3\n", {"no line POINTS"});
}

TEST_F(BadPcdFiles, NumbersThatAreNoneAreRefused) {
  expectHeaderRefused("WIDTH 1", "WIDTH -1", {"line 7", "'-1'"});
  expectHeaderRefused("WIDTH 1", "WIDTH one", {"line 7", "'one'"});
  expectHeaderRefused("WIDTH 1", "WIDTH 1.5", {"line 7", "'1.5'"});
  expectHeaderRefused("HEIGHT 1", "HEIGHT 1 1", {"line 8", "2 numbers instead of 1"});
  expectHeaderRefused("POINTS 1", "POINTS 99999999999999999999", {"line 10", "64 bits"});
  expectHeaderRefused("COUNT 1 1 1", "COUNT 1 -1 1", {"line 6", "'-1'"});
  expectHeaderRefused("VIEWPOINT 0", "VIEWPOINT zero", {"line 9", "'zero'"});
  expectHeaderRefused("VIEWPOINT 0", "VIEWPOINT", {"line 9", "6 numbers", "qw qx qy qz"});
}

TEST_F(BadPcdFiles, SizesThatOverflowAreRefused) {
  const std::string fields = "FIELDS x y z a\nSIZE 4 4 4 8\nTYPE F F F U\nCOUNT 1 1 1 ";
  expectRefused(fields + "9000000000000000000\nPOINTS 1\nDATA binary\n", {"line 4", "overflows"});
  expectRefused(fields + "2000000000000000000\nPOINTS 2\nDATA binary\n", {"2 points", "cut off"});
  expectRefused(fields + "2000000000000000000\nPOINTS 20\nDATA ascii\n", {"20 points", "cut off"});
  expectRefused("FIELDS x y z\nWIDTH 5000000000\nHEIGHT 5000000000\nPOINTS 1\nDATA binary\n", {"line 2", "overflows"});
  expectRefused("FIELDS x y z\nPOINTS 18446744073709551615\nDATA binary\n" + std::string(100, 'x'), {"cut off"});
  expectRefused("FIELDS x y z\nPOINTS 1537228672809129302\nDATA binary\n" + std::string(100, 'x'), {"cut off"});
}

TEST_F(BadPcdFiles, SizesThatLieAreRefusedBeforeMemoryIsTaken) {
  for (const std::string points : {"4000000000", "1000000000000000", "18446744073709551615"}) {
    const std::string head = "FIELDS x y z\nPOINTS " + points + "\nDATA ";
    expectRefused(head + "ascii\n1 2 3\n", {"only 6 bytes"});
    expectRefused(head + "binary\n1 2 3\n", {"byte "});
    expectRefused(head + "binary_compressed\n" + bytesOf(std::uint32_t{4}) + bytesOf(~std::uint32_t{0}) + "abcd",
                  {"byte "});
  }
}

TEST_F(BadPcdFiles, AsciiLinesWithOtherThanTheirColumnsAreRefused) {
  const std::string header = xyzHeader(2, "ascii");
  expectRefused(header + "1 2 3\n4 5\n6 7 8\n", {"line 13", "2 columns instead of 3"});
  expectRefused(header + "1 2 3\n4 5 6 7\n", {"line 13", "more than 3 columns"});
  expectRefused(header + "1 2 3\n         \n", {"1 of 2 points"});
  expectRefused(header + "1 2 3\n4 5 6\n7 8 9\n", {"line 14", "more data"});
}

TEST_F(BadPcdFiles, TextAmongAsciiNumbersIsRefused) {
  const std::string header = xyzHeader(1, "ascii");
  for (const std::string word : {"abc", "1,5", "1.5m", "++1", "+-1", "1e", "0x10", "--1", "+", "1e400", "-1e39", "1d0"})
    expectRefused(header + "1 " + word + " 3\n", {"line 12", "'" + word + "'"});
  expectRefused(header + "1 2 3\0" + std::string(1, '\0') + "\n", {"line 12"});
}

TEST_F(BadPcdFiles, TextInAColumnIsRefusedWhereTheColumnIsRead) {
  const PcdReader reader(directory_.write("scan.pcd", "FIELDS x y z label\nPOINTS 1\nDATA ascii\n1 2 3 car\n"));
  EXPECT_EQ(readAll(reader)[2], std::vector<double>{3});
  EXPECT_THROW(reader.column("label"), FileError);
}

TEST_F(BadPcdFiles, ColumnsWithoutANumberAreRefused) {
  const PcdReader reader(directory_.write("scan.pcd",
                                          "FIELDS x y z half _\nSIZE 4 4 4 2 1\nTYPE F F F F U\nPOINTS 1\n"
                                          "DATA binary\n" +
                                              std::string(15, '\0')));
  EXPECT_EQ(readAll(reader)[2], std::vector<double>{0});
  EXPECT_THROW(reader.column("half"), FileError);
  EXPECT_THROW(reader.column("_"), FileError);
}

TEST_F(BadPcdFiles, BinaryDataShortByAByteAreRefused) {
  expectRefused(xyzHeader(2, "binary") + std::string(23, 'x'), {"byte ", "23 bytes", "2 points of 12 bytes"});
}

TEST_F(BadPcdFiles, CompressedSizesThatLieEitherWayAreRefused) {
  const std::string bytes(36, 'q'), stream = test::lzfLiterals(bytes), header = xyzHeader(3, "binary_compressed");
  const auto body = [&](std::size_t compressed, std::size_t expanded, const std::string& tail = "") {
    return header + bytesOf(static_cast<std::uint32_t>(compressed)) + bytesOf(static_cast<std::uint32_t>(expanded)) +
           stream + tail;
  };
  ASSERT_EQ(complaint(directory_.write("good.pcd", body(stream.size(), 36))), "");
  expectRefused(body(stream.size() + 1, 36), {"byte ", "cut off"});
  expectRefused(body(stream.size() + 2, 36, "ab"), {"byte ", "damaged"});
  expectRefused(body(stream.size() - 1, 36), {"byte ", "damaged"});
  expectRefused(body(0, 36), {"byte ", "cannot expand"});
  expectRefused(body(stream.size(), 35), {"byte ", "35 bytes"});
  expectRefused(body(stream.size(), 37), {"byte ", "37 bytes"});
  expectRefused(header + "1234567", {"byte ", "two sizes"});
  expectRefused(header + bytesOf(std::uint32_t{40}) + bytesOf(std::uint32_t{36}) + std::string(40, '\xFF'),
                {"byte ", "damaged"});
}

TEST_F(BadPcdFiles, CompressedDataCannotClaimMoreThanTheFormatAllows) {
  const std::size_t points = 1000000;  // 12 MB out of 100 bytes
  expectRefused(xyzHeader(points, "binary_compressed") + bytesOf(std::uint32_t{100}) +
                    bytesOf(static_cast<std::uint32_t>(12 * points)) + std::string(100, 'x'),
                {"byte ", "cannot expand"});
}

TEST_F(BadPcdFiles, EveryMutationIsReadOrRefused) {
  std::string text, records;
  for (int i = 0; i < 24; ++i) {
    text += std::to_string(i) + (i % 3 == 2 ? ".5\n" : ".25 ");
    records += bytesOf(static_cast<float>(i));
  }
  // A stream with a back reference: 95 more zeros from one, then one literal.
  const std::string stream = std::string("\0\0\xE0\x56\0\0\0", 7);
  const std::vector<std::string> good = {
      xyzHeader(8, "ascii") + text, xyzHeader(8, "binary") + records,
      xyzHeader(8, "binary_compressed") + compressedBody(records),
      xyzHeader(8, "binary_compressed") + bytesOf(std::uint32_t{7}) + bytesOf(std::uint32_t{97}) + stream};
  test::expectMutationsReadOrRefused(good, [&](const std::string& bytes) {
    const PcdReader reader(directory_.write("scan.pcd", bytes));
    readAll(reader);
    reader.fingerprint();
    for (const PcdField& field : reader.header().fields)
      if (reader.header().find(field.name)) reader.column(field.name, field.count - 1);
  });
}

}  // namespace
}  // namespace gaussmap
