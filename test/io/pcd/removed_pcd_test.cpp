// SPDX-License-Identifier: BSD-3-Clause
#include "io/pcd/removed_pcd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "gaussmap/io/pcd/pcd_reader.h"
#include "io/files/file_contents.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
using namespace detail;

namespace {

using Cluster = RemovedCluster<3>;

/// A finest cluster of two points, (-3, 4, 5) and (1, 2, 3) steps off the centre of its cell.
Cluster finest() {
  Cluster one;
  one.scale = 0;
  one.key = {-7, 0, 2147483647};
  one.moments.add({-3, 4, 5});
  one.moments.add({1, 2, 3});
  one.gaussian.mean = {-0.65, 0.1 + 0.2, 1e7};
  one.gaussian.cov << 1.0, 0.1, 0.2, 0.1, 2.0, 0.3, 0.2, 0.3, 3.0;
  one.gaussian.weight = 2.0;
  one.log_odds = -0.1;
  one.evidence = {3, 9, 1, 4294967295u};
  one.scan = 17;
  return one;
}

Cluster coarse() {
  Cluster one = finest();
  one.scale = 2;
  one.moments = {};
  one.gaussian.weight = 0.5;
  return one;
}

void expectEqual(const Cluster& a, const Cluster& b) {
  EXPECT_EQ(a.scale, b.scale);
  EXPECT_EQ(a.key, b.key);
  EXPECT_TRUE(a.moments == b.moments);
  EXPECT_EQ(a.gaussian.mean, b.gaussian.mean);
  EXPECT_EQ(a.gaussian.cov, b.gaussian.cov);
  EXPECT_EQ(a.gaussian.weight, b.gaussian.weight);
  EXPECT_EQ(a.log_odds, b.log_odds);
  EXPECT_EQ(a.evidence.hits, b.evidence.hits);
  EXPECT_EQ(a.evidence.misses, b.evidence.misses);
  EXPECT_EQ(a.evidence.first_hit, b.evidence.first_hit);
  EXPECT_EQ(a.evidence.last_hit, b.evidence.last_hit);
  EXPECT_EQ(a.scan, b.scan);
}

class RemovedPcdTest : public ::testing::Test {
 protected:
  std::filesystem::path path() const { return directory_.path() / "removed.pcd"; }

  /// Writes a finest cluster with a fault and expects that it is refused, by its number.
  void expectRefused(const std::function<void(Cluster&)>& harm) const {
    Cluster bad = finest();
    harm(bad);
    writeRemoved(path(), {coarse(), bad});
    try {
      readRemoved(path());
      ADD_FAILURE() << "was read";
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("point 1 is not a cluster"), std::string::npos) << error.what();
    }
  }
  void expectNoCloudOfClusters(const std::filesystem::path& path, const std::string& field) const {
    try {
      readRemoved(path);
      ADD_FAILURE() << "was read";
    } catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("'" + field + "' is missing"), std::string::npos) << error.what();
    }
  }

  test::TemporaryDirectory directory_;
};

TEST_F(RemovedPcdTest, ReadsWhatItWroteToTheLastBit) {
  const std::vector<Cluster> removed = {finest(), coarse(), finest()};
  writeRemoved(path(), removed);
  const std::vector<Cluster> read = readRemoved(path());
  ASSERT_EQ(read.size(), removed.size());
  for (std::size_t i = 0; i < read.size(); ++i) expectEqual(read[i], removed[i]);
}

TEST_F(RemovedPcdTest, IsACloudThatAnyProgramCanColour) {
  writeRemoved(path(), {finest(), coarse()});
  const PcdReader reader(path());
  EXPECT_EQ(reader.size(), 2u);
  EXPECT_EQ(reader.column("x"), (std::vector<double>{-0.65, -0.65}));
  EXPECT_EQ(reader.column("misses"), (std::vector<double>{9, 9}));
  EXPECT_EQ(reader.column("deleted_after"), (std::vector<double>{17, 17}));
  EXPECT_EQ(reader.column("count"), (std::vector<double>{2, 0}));
}

TEST_F(RemovedPcdTest, MayBeEmpty) {
  writeRemoved(path(), {});
  EXPECT_TRUE(readRemoved(path()).empty());
}

TEST_F(RemovedPcdTest, RefusesCloudsWithoutOneOfItsFields) {
  const std::string header =
      "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 0\nHEIGHT 1\nPOINTS 0\nDATA binary\n";
  expectNoCloudOfClusters(directory_.write("empty.pcd", header), "covariance");
  writeRemoved(path(), {finest()});
  std::string bytes = test::contentsOf(path());
  bytes.replace(bytes.find("log_odds"), 8, "log_oddz");
  expectNoCloudOfClusters(directory_.write("renamed.pcd", bytes), "log_odds");
}

TEST_F(RemovedPcdTest, RefusesFieldsOfAnotherType) {
  writeRemoved(path(), {finest()});
  std::string bytes = test::contentsOf(path());
  const std::size_t types = bytes.find("TYPE F F F F F U");
  ASSERT_NE(types, std::string::npos);
  bytes[types + 15] = 'I';
  expectNoCloudOfClusters(directory_.write("types.pcd", bytes), "scale");
}

TEST_F(RemovedPcdTest, RefusesNumbersThatNoClusterHas) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  expectRefused([](Cluster& one) { one.gaussian.mean.y() = kNan; });
  expectRefused([](Cluster& one) { one.gaussian.cov(0, 2) = kInfinity; });
  expectRefused([](Cluster& one) { one.gaussian.weight = -1.0; });
  expectRefused([](Cluster& one) { one.gaussian.weight = kNan; });
  expectRefused([](Cluster& one) { one.log_odds = kNan; });
  expectRefused([](Cluster& one) { one.scale = -1; });
  expectRefused([](Cluster& one) { one.scale = 1000; });
}

TEST_F(RemovedPcdTest, RefusesSumsThatNoPointsHave) {
  expectRefused([](Cluster& one) { one.moments.count = -1; });
  expectRefused([](Cluster& one) { one.moments.count = std::int64_t{1} << 33; });
  expectRefused([](Cluster& one) { one.moments.count = 0; });  // but there are sums
  expectRefused([](Cluster& one) { one.moments.sum[1] = 2 * 32768 + 1; });
  expectRefused([](Cluster& one) { one.moments.product[1] = std::numeric_limits<std::int64_t>::min(); });
  expectRefused([](Cluster& one) { one.moments.product[3] = -1; });
  Cluster largest = finest();
  largest.moments.sum[1] = -2 * 32768;
  largest.moments.product[3] = 2 * (std::int64_t{1} << 30);
  writeRemoved(path(), {largest});
  EXPECT_EQ(readRemoved(path()).size(), 1u);
}

}  // namespace
}  // namespace gaussmap
