// SPDX-License-Identifier: BSD-3-Clause
// Maps of other programs: an older one, and one that is to come.
#include "gaussmap/io/gmap/map_reader.h"
#include "gaussmap/io/gmap/map_update.h"
#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

const MapOptions kOptions{0.25, 4, 3, 0.0};

/// What test/data/map_of_the_first_program.gmap was made of (pcd2map --frame map --budget 2), by the first program that
/// wrote maps.
std::vector<Vector<3>> oldPoints() {
  std::vector<Vector<3>> points;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) points.emplace_back(0.125 * i, 0.125 * j, 0.03125 * (i * j % 7));
  return points;
}

class OldMap : public MapFile {
 protected:
  void SetUp() override {
    fs::copy_file(fs::path(GAUSSMAP_TEST_DATA) / "map_of_the_first_program.gmap", path_);
    fs::permissions(path_, fs::perms::owner_all);
  }
  const fs::path path_ = directory_.path() / "old.gmap";
};

TEST_F(OldMap, Opens) {
  const GaussianMapOctree old = load(path_), fresh = build<3>(oldPoints(), kOptions);
  ASSERT_EQ(old.scales(), 3);
  EXPECT_TRUE(old.acceptsScans());
  EXPECT_EQ(old.scale(0).keys, fresh.scale(0).keys);
  EXPECT_EQ(old.scale(0).moments, fresh.scale(0).moments);
  for (int s = 1; s < 3; ++s) {
    EXPECT_EQ(old.scale(s).keys, fresh.scale(s).keys);
    EXPECT_EQ(old.gaussianCount(s), 2 * old.cellCount(s));
    EXPECT_DOUBLE_EQ(old.weight(s), 1600.0);
  }
  EXPECT_EQ(MapReader<3>(path_).load({Vector<3>::Constant(-1.0), Vector<3>::Constant(9.0)}).cellCount(0), 400u);
  EXPECT_NE(loadMetadata(path_).at("history").find("pcd2map"), std::string::npos);
}

TEST_F(OldMap, TakesMoreScans) {
  const auto more = randomCloud<3>(2000, 71);
  MomentGrid<3> added(kOptions.resolution);
  added.addPoints(more);
  EXPECT_EQ(growingMapOptions<3>(path_).resolution, 0.25);
  updateMap<3>(path_, added);
  std::vector<Vector<3>> all = oldPoints();
  all.insert(all.end(), more.begin(), more.end());
  const GaussianMapOctree grown = load(path_), fresh = build<3>(all, kOptions);
  EXPECT_EQ(grown.scale(0).keys, fresh.scale(0).keys);
  EXPECT_EQ(grown.scale(0).moments, fresh.scale(0).moments);
  for (int s = 0; s < 3; ++s) EXPECT_DOUBLE_EQ(grown.weight(s), 3600.0);
  updateMap<3>(path_, added);  // it is a map of today by now
  EXPECT_EQ(shell(path_, "SELECT value FROM metadata WHERE name = 'grows'"), std::vector<std::string>{"1"});
}

TEST_F(OldMap, OfAnotherSchemaIsRefusedWithTheWayOut) {
  for (const char* const version : {"0", "2"}) {
    shell(path_, std::string("PRAGMA user_version = ") + version);
    const std::string why =
        std::string("has schema version ") + version + ", this program reads version 1: use the gaussmap that wrote it";
    expectRefused(path_, why);
    expectComplaint(complaintOf([&] { growingMapOptions<3>(path_); }), path_, {why});
    expectComplaint(complaintOf([&] { MapReader<3> reader(path_); }), path_, {why});
  }
}

}  // namespace
}  // namespace gaussmap::test
