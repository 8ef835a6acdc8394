// SPDX-License-Identifier: BSD-3-Clause
// PCD headers of other programs that PCL 1.13 reads.
#include <gtest/gtest.h>

#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/files/file_contents.h"
#include "io/files/temporary_directory.h"
#include "io/pcd/pcd_bytes.h"
#include "io/pcd/pcd_records.h"

namespace gaussmap::test {
using namespace detail;

namespace {

using Axes = std::vector<std::vector<double>>;

class ForeignHeaders : public testing::Test {
 protected:
  /// Returns the coordinates of two points after `from` is replaced by `to` in a good header.
  Axes readWith(const std::string& from, const std::string& to, const std::string& body = "1 2 3\n4 5 6\n") const {
    std::string text = xyzHeader(2, "ascii") + body;
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    text.replace(place, from.size(), to);
    return readAll(PcdReader(directory_.write("scan.pcd", text)));
  }

  TemporaryDirectory directory_;
  const Axes two_{{1, 4}, {2, 5}, {3, 6}};
};

TEST_F(ForeignHeaders, LettersOfTypesCanBeSmallOrWords) {
  EXPECT_EQ(readWith("TYPE F F F", "TYPE f f f"), two_);
  EXPECT_EQ(readWith("TYPE F F F", "TYPE f F float"), two_);
}

TEST_F(ForeignHeaders, EncodingsCanHaveCapitals) {
  EXPECT_EQ(readWith("DATA ascii", "DATA Ascii"), two_);
  EXPECT_EQ(readWith("DATA ascii", "DATA ASCII"), two_);
  const std::string bytes = bytesOf(1.0f) + bytesOf(2.0f) + bytesOf(3.0f);
  for (const std::string encoding : {"BINARY", "Binary"})
    EXPECT_EQ(readAll(PcdReader(directory_.write("b.pcd", xyzHeader(1, encoding) + bytes))), (Axes{{1}, {2}, {3}}));
  EXPECT_EQ(readAll(PcdReader(directory_.write("c.pcd", xyzHeader(1, "BINARY_COMPRESSED") + compressedBody(bytes)))),
            (Axes{{1}, {2}, {3}}));
}

TEST_F(ForeignHeaders, VersionsCanStartWithALetter) {
  EXPECT_EQ(readWith("VERSION 0.7", "VERSION v.7"), two_);
  EXPECT_EQ(readWith("VERSION 0.7", "VERSION V0.6"), two_);
  EXPECT_EQ(readWith("VERSION 0.7", "VERSION PCD_V7"), two_);
}

TEST_F(ForeignHeaders, CommentsCanFollowALineOrStandBetweenThePoints) {
  EXPECT_EQ(readWith("POINTS 2", "POINTS 2 # two of them"), two_);
  EXPECT_EQ(readWith("DATA ascii", "DATA ascii # text"), two_);
  EXPECT_EQ(readWith("", "", "# first\n1 2 3\n  # second\n4 5 6\n# end"), two_);
}

TEST_F(ForeignHeaders, TruthValuesAreNumbers) {
  const std::string text =
      "FIELDS x y z ok\nSIZE 4 4 4 1\nTYPE F F F B\nCOUNT 1 1 1 1\nPOINTS 2\nDATA ascii\n1 2 3 1\n4 5 6 0\n";
  EXPECT_EQ(PcdReader(directory_.write("scan.pcd", text)).column("ok"), (std::vector<double>{1, 0}));
}

TEST_F(ForeignHeaders, CoordinatesCanHaveCapitals) {
  EXPECT_EQ(readWith("FIELDS x y z", "FIELDS X Y Z"), two_);
  // If there are small letters, capital ones are other fields.
  const std::string text = "FIELDS X x y z\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nPOINTS 1\nDATA ascii\n9 1 2 3\n";
  const PcdReader reader(directory_.write("both.pcd", text));
  EXPECT_EQ(readAll(reader), (Axes{{1}, {2}, {3}}));
  EXPECT_EQ(reader.column("X"), std::vector<double>{9});
}

TEST_F(ForeignHeaders, FieldsOfCountZeroHoldNothing) {
  const std::string fields = "FIELDS x _ y z pad\nSIZE 4 1 4 4 8\nTYPE F U F F F\nCOUNT 1 0 1 1 0\nPOINTS 1\nDATA ";
  const std::string bytes = bytesOf(1.0f) + bytesOf(2.0f) + bytesOf(3.0f);
  for (const std::string& body :
       {std::string("ascii\n1 2 3\n"), "binary\n" + bytes, "binary_compressed\n" + compressedBody(bytes)}) {
    const PcdReader reader(directory_.write("scan.pcd", fields + body));
    EXPECT_EQ(readAll(reader), (Axes{{1}, {2}, {3}}));
    EXPECT_EQ(reader.header().fields.size(), 3u);
    EXPECT_EQ(reader.header().find("pad"), nullptr);
    writePcd(directory_.path() / "copy.pcd", readRecords(reader));
    EXPECT_EQ(readAll(PcdReader(directory_.path() / "copy.pcd")), (Axes{{1}, {2}, {3}}));
  }
}

TEST_F(ForeignHeaders, NamesCanOccurTwiceAndAreKept) {
  const std::string fields = "FIELDS x y z i i\nSIZE 4 4 4 4 2\nTYPE F F F F U\nCOUNT 1 1 1 1 1\nPOINTS 2\nDATA ";
  const std::string bytes = bytesOf(1.0f) + bytesOf(2.0f) + bytesOf(3.0f) + bytesOf(0.5f) + bytesOf(std::uint16_t{7});
  for (const std::string& body : {std::string("ascii\n1 2 3 0.5 7\n1 2 3 0.5 7\n"), "binary\n" + bytes + bytes}) {
    const PcdReader reader(directory_.write("scan.pcd", fields + body));
    EXPECT_EQ(readAll(reader), (Axes{{1, 1}, {2, 2}, {3, 3}}));
    EXPECT_EQ(reader.column("i"), (std::vector<double>{0.5, 0.5}));  // the first one
    const PcdRecords records = readRecords(reader);
    checkWritable(reader);
    writePcd(directory_.path() / "copy.pcd", records);
    const std::string copy = contentsOf(directory_.path() / "copy.pcd");
    EXPECT_NE(copy.find("FIELDS x y z i i\n"), std::string::npos);
    EXPECT_EQ(copy.substr(copy.size() - 2 * bytes.size()), bytes + bytes);
  }
}

TEST_F(ForeignHeaders, CoordinatesMustOccurOnce) {
  const std::string text = "FIELDS x y z x\nSIZE 4 4 4 4\nTYPE F F F F\nPOINTS 1\nDATA ascii\n1 2 3 4\n";
  EXPECT_THROW(PcdReader(directory_.write("scan.pcd", text)), FileError);
}

}  // namespace
}  // namespace gaussmap::test
