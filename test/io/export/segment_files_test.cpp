// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/export/segment_files.h"

#include <gtest/gtest.h>

#include <limits>

#include "gaussmap/core/gaussian.h"
#include "gaussmap/io/pcd/pcd_reader.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/files/file_contents.h"
#include "io/files/hostile_files.h"
#include "io/files/temporary_directory.h"

namespace gaussmap {
namespace {

using test::contentsOf;

/// Chains of 1, 2, 3, ... segments with numbers that no decimal fraction has, every second one closed.
SegmentMap randomMap(std::size_t chains, double offset = 0.0, std::uint64_t seed = 1) {
  Random random(seed);
  SegmentMap map;
  for (std::size_t c = 0; c < chains; ++c) {
    const std::size_t first = map.segments.size();
    for (std::size_t i = 0; i <= c; ++i) {
      Segment segment;
      segment.start = Vector<2>(offset + 100.0 * random.normal(), 100.0 * random.normal());
      segment.end = Vector<2>(offset + 100.0 * random.normal(), 100.0 * random.normal());
      segment.normal_variance = random.uniform();
      segment.covariance << 1.0 + random.uniform(), 0.1, 0.1, 1.0 + random.uniform();
      segment.weight = 1000.0 * random.uniform();
      segment.last_seen = static_cast<std::int64_t>(random.below(1u << 30)) << 20;
      map.segments.push_back(segment);
    }
    map.chains.push_back({first, map.segments.size(), c % 2 == 1});
  }
  return map;
}

void expectEqual(const SegmentMap& a, const SegmentMap& b) {
  ASSERT_EQ(a.segments.size(), b.segments.size());
  ASSERT_EQ(a.chains.size(), b.chains.size());
  for (std::size_t i = 0; i < a.segments.size(); ++i) {
    const Segment &s = a.segments[i], &t = b.segments[i];
    EXPECT_EQ(s.start, t.start);
    EXPECT_EQ(s.end, t.end);
    EXPECT_EQ(s.normal_variance, t.normal_variance);
    EXPECT_EQ(s.covariance, t.covariance);
    EXPECT_EQ(s.weight, t.weight);
    EXPECT_EQ(s.last_seen, t.last_seen);
  }
  for (std::size_t c = 0; c < a.chains.size(); ++c) {
    EXPECT_EQ(a.chains[c].first, b.chains[c].first);
    EXPECT_EQ(a.chains[c].last, b.chains[c].last);
    EXPECT_EQ(a.chains[c].closed, b.chains[c].closed);
  }
}

class SegmentFiles : public testing::Test {
 protected:
  std::filesystem::path own(const std::string& name) const { return directory_.path() / name; }
  test::TemporaryDirectory directory_;
};

TEST_F(SegmentFiles, ComeBackFromPcdToTheLastBit) {
  for (const double offset : {0.0, 1e7, -3e5}) {
    const SegmentMap map = randomMap(6, offset);
    saveSegmentsPcd(own("map.pcd"), map);
    expectEqual(loadSegmentsPcd(own("map.pcd")), map);
  }
  saveSegmentsPcd(own("empty.pcd"), {});
  expectEqual(loadSegmentsPcd(own("empty.pcd")), {});
}

TEST_F(SegmentFiles, GiveTheSameBytesForTheSameMap) {
  const SegmentMap map = randomMap(4);
  for (const char* const name : {"a", "b"}) {
    saveSegmentsPcd(own(name + std::string(".pcd")), map);
    saveSegmentsCsv(own(name + std::string(".csv")), map);
    saveSegmentsGeoJson(own(name + std::string(".geojson")), map);
  }
  for (const char* const extension : {".pcd", ".csv", ".geojson"})
    EXPECT_EQ(contentsOf(own(std::string("a") + extension)), contentsOf(own(std::string("b") + extension)));
}

TEST_F(SegmentFiles, ShowEndPointsAndNormalsInPcd) {
  SegmentMap map;
  map.segments.resize(1);
  map.segments[0].start = {1, 2};
  map.segments[0].end = {1, 5};  // upwards: free space on the left, towards -x
  map.chains = {{0, 1, false}};
  saveSegmentsPcd(own("map.pcd"), map);
  const PcdReader reader(own("map.pcd"));
  EXPECT_EQ(reader.header().width, 2u);
  EXPECT_EQ(reader.header().height, 1u);
  EXPECT_EQ(reader.column("x"), (std::vector<double>{1, 1}));
  EXPECT_EQ(reader.column("y"), (std::vector<double>{2, 5}));
  EXPECT_EQ(reader.column("z"), (std::vector<double>{0, 0}));
  EXPECT_EQ(reader.column("normal_x"), (std::vector<double>{-1, -1}));
  EXPECT_EQ(reader.column("normal_y"), (std::vector<double>{0, 0}));
}

SegmentMap oneSegment() {
  SegmentMap map;
  map.segments.resize(1);
  Segment& segment = map.segments[0];
  segment.start = {0.5, 0};
  segment.end = {3.5, 4};
  segment.normal_variance = 0.25;
  segment.covariance << 1, 0.5, 0.5, 2;
  segment.weight = 12.5;
  segment.last_seen = 7;
  map.chains = {{0, 1, true}};
  return map;
}

TEST_F(SegmentFiles, AreOneLineASegmentInCsv) {
  saveSegmentsCsv(own("map.csv"), oneSegment());
  EXPECT_EQ(contentsOf(own("map.csv")),
            "chain,closed,start_x,start_y,end_x,end_y,length,normal_variance,offset_variance,offset_angle_covariance,"
            "angle_variance,weight,last_seen\n0,1,0.5,0,3.5,4,5,0.25,1,0.5,2,12.5,7\n");
}

TEST_F(SegmentFiles, AreLineStringsInGeoJson) {
  saveSegmentsGeoJson(own("map.geojson"), oneSegment());
  EXPECT_EQ(contentsOf(own("map.geojson")),
            "{\"type\":\"FeatureCollection\",\"features\":[\n"
            "{\"type\":\"Feature\",\"geometry\":{\"type\":\"LineString\",\"coordinates\":[[0.5,0],[3.5,4]]},"
            "\"properties\":{\"chain\":0,\"closed\":true,\"length\":5,\"normal_variance\":0.25,\"offset_variance\":1,"
            "\"offset_angle_covariance\":0.5,\"angle_variance\":2,\"weight\":12.5,\"last_seen\":7}}\n]}\n");
  saveSegmentsGeoJson(own("empty.geojson"), {});
  EXPECT_EQ(contentsOf(own("empty.geojson")), "{\"type\":\"FeatureCollection\",\"features\":[\n]}\n");
}

TEST_F(SegmentFiles, AreNotWrittenIfANumberIsNotFinite) {
  const auto expectRefused = [&](const SegmentMap& map) {
    EXPECT_THROW(saveSegmentsPcd(own("x"), map), std::invalid_argument);
    EXPECT_THROW(saveSegmentsCsv(own("x"), map), std::invalid_argument);
    EXPECT_THROW(saveSegmentsGeoJson(own("x"), map), std::invalid_argument);
    EXPECT_TRUE(std::filesystem::is_empty(directory_.path()));
  };
  const double bad = std::numeric_limits<double>::quiet_NaN();
  SegmentMap map = oneSegment();
  map.segments[0].end.x() = bad;
  expectRefused(map);
  map = oneSegment();
  map.segments[0].covariance(0, 1) = bad;
  expectRefused(map);
  map = oneSegment();
  map.segments[0].weight = std::numeric_limits<double>::infinity();
  expectRefused(map);
  map = oneSegment();
  map.chains.clear();
  expectRefused(map);
  map.chains = {{0, 2, false}};
  expectRefused(map);
  map = oneSegment();
  map.segments[0].end.x() = 1e40;
  EXPECT_THROW(saveSegmentsPcd(own("x"), map), std::invalid_argument);
  EXPECT_THROW(saveSegmentsCsv(own("none/x"), oneSegment()), FileError);
}

TEST_F(SegmentFiles, RefuseCloudsThatAreNoMaps) {
  writePcd(own("cloud.pcd"), {{1, 2, 3}});
  test::expectComplaint(test::complaintOf([&] { loadSegmentsPcd(own("cloud.pcd")); }), own("cloud.pcd"),
                        {"not a map of segments", "missing"});
  directory_.write("text.pcd", "hello");
  EXPECT_NE(test::complaintOf([&] { loadSegmentsPcd(own("text.pcd")); }), "");
}

TEST_F(SegmentFiles, AreReadOrRefusedWhateverTheirBytesAre) {
  saveSegmentsPcd(own("good.pcd"), randomMap(2));
  test::expectMutationsReadOrRefused({contentsOf(own("good.pcd"))}, [&](const std::string& bytes) {
    const SegmentMap map = loadSegmentsPcd(directory_.write("bad.pcd", bytes));
    EXPECT_NO_THROW(saveSegmentsCsv(own("again.csv"), map));  // whatever was read is a map
  });
}

}  // namespace
}  // namespace gaussmap
