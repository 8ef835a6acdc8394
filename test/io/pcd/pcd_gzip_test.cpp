// SPDX-License-Identifier: BSD-3-Clause
// PCD files that were compressed with gzip.
#include <gtest/gtest.h>

#include "io/files/temporary_directory.h"
#include "io/logs/gzip.h"
#include "io/pcd/pcd_bytes.h"

namespace gaussmap::test {
namespace {

class GzippedPcd : public testing::Test {
 protected:
  std::string complaintOf(const std::string& bytes) const {
    try {
      readAll(PcdReader(directory_.write("scan.pcd.gz", bytes)));
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryDirectory directory_;
};

TEST_F(GzippedPcd, AreReadLikeTheFileItself) {
  std::string bytes;
  std::string text;
  for (int i = 0; i < 700; ++i) {
    for (const float value : {0.5f * static_cast<float>(i), -1.0f, 3.25f}) bytes += bytesOf(value);
    text += std::to_string(0.5 * i) + " -1 3.25\n";
  }
  for (const std::string& plain : {xyzHeader(700, "ascii") + text, xyzHeader(700, "binary") + bytes}) {
    const PcdReader expected(directory_.write("scan.pcd", plain));
    const PcdReader reader(directory_.write("scan.pcd.gz", gzipped(plain)));
    EXPECT_EQ(reader.size(), 700u);
    EXPECT_EQ(readAll(reader), readAll(expected));
    EXPECT_EQ(readAll(reader.sameFile()), readAll(expected));
    EXPECT_EQ(reader.column("x"), expected.column("x"));
    EXPECT_EQ(reader.records(), expected.records());
  }
}

TEST_F(GzippedPcd, CanConsistOfSeveralParts) {
  const std::string head = gzipped(xyzHeader(2, "ascii")), body = gzipped("1 2 3\n4 5 6\n");
  EXPECT_EQ(readAll(PcdReader(directory_.write("a.pcd", head + body))),
            (std::vector<std::vector<double>>{{1, 4}, {2, 5}, {3, 6}}));
}

TEST_F(GzippedPcd, AreRefusedIfTheyAreDamaged) {
  const std::string good = gzipped(xyzHeader(2, "ascii") + "1 2 3\n4 5 6\n");
  EXPECT_EQ(complaintOf(good), "");
  EXPECT_NE(complaintOf(good.substr(0, good.size() / 2)).find("cut off"), std::string::npos);
  EXPECT_NE(complaintOf(good + "more").find("follow the gzip data"), std::string::npos);
  EXPECT_NE(complaintOf(gzipped(xyzHeader(3, "ascii") + "1 2 3\n4 5 6\n")).find("3 points of 3 numbers"),
            std::string::npos);
  EXPECT_NE(complaintOf(gzipped("no header")), "");
  std::string damaged = good;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 0x55);
  EXPECT_NE(complaintOf(damaged), "");
}

TEST_F(GzippedPcd, MayNotExpandToFarMoreThanTheirSize) {
  const std::string zeros(std::size_t{48} << 20, '\0');
  EXPECT_NE(complaintOf(gzipped(xyzHeader(1, "binary") + zeros)).find("100 times its size"), std::string::npos);
  EXPECT_NE(complaintOf(gzipped(xyzHeader(900000000, "binary"))).find("claims 900000000 points"), std::string::npos);
  EXPECT_NE(complaintOf(gzipped(xyzHeader(900000000, "ascii"))).find("claims 900000000 points"), std::string::npos);
}

}  // namespace
}  // namespace gaussmap::test
