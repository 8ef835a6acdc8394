// SPDX-License-Identifier: BSD-3-Clause
// Maps whose finer scales are incomplete, to files and back.
#include <gtest/gtest.h>

#include "editing/thinned_map.h"
#include "gaussmap/editing/compress.h"
#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/map/queries.h"
#include "gaussmap/mapping/refine.h"
#include "io/gmap/map_file_fixture.h"

namespace gaussmap {
using namespace detail;

namespace {

using test::MapFile;
using test::randomCloud;
using test::thinned;

/// The coarsest scale and nothing under it.
GaussianMapOctree bare(const GaussianMapOctree& map) {
  return keepCells<3>(map, {std::vector<char>(map.cellCount(0), false), std::vector<char>(map.cellCount(1), false),
                            std::vector<char>(map.cellCount(2), true)});
}

TEST_F(MapFile, GivesBackEveryBitOfACompressedMap) {
  for (const int ratio : {2, 3, 10}) {
    const GaussianMapOctree map = build<3>(randomCloud<3>(3000, 25), {0.1, ratio, 3, 0.0});
    ASSERT_TRUE(thinned(map).isCompressed());
    expectRoundTrip<3>(thinned(map));
    expectRoundTrip<3>(thinned(refine<3>(map).map));
    expectRoundTrip<3>(bare(refine<3>(map).map));
    expectRoundTrip<3>(compress(refine<3>(map).map, 0.1));
  }
  expectRoundTrip<2>(thinned(build<2>(randomCloud<2>(3000, 26), {0.07, 3, 4, 0.0})));
}

TEST_F(MapFile, KnowsThatACompressedMapCannotGrow) {
  const GaussianMapOctree map = thinned(build<3>(randomCloud<3>(1000, 27), {0.1, 4, 3, 0.0}));
  ASSERT_FALSE(map.scale(0).moments.empty());
  const auto path = directory_.path() / "small.gmap";
  save(path, map);
  EXPECT_TRUE(load(path).isCompressed());
  EXPECT_FALSE(load(path).acceptsScans());
}

TEST_F(MapFile, OfACompressedMapIsSmaller) {
  const GaussianMapOctree map = build<3>(randomCloud<3>(3000, 28), {0.1, 4, 3, 0.0});
  EXPECT_LT(savedSize<3>(thinned(map)), savedSize<3>(map));
  EXPECT_LT(savedSize<3>(bare(map)), savedSize<3>(thinned(map)));
}

TEST_F(MapFile, MayLackChildrenButNoParent) {
  const auto path = directory_.path() / "map.gmap";
  const auto saveWithoutTile = [&](const std::string& scale) {
    save(path, build<3>({{0.5, 0.5, 0.5}, {500.5, 0.5, 0.5}}, {0.1, 10, 2, 0.0}), {}, {true, 3, 0});
    test::shell(path, "DELETE FROM tiles WHERE scale = " + scale + " AND x > 0;" +
                          "UPDATE metadata SET value = '1' WHERE name = 'cells." + scale + "'");
  };
  saveWithoutTile("0");
  EXPECT_TRUE(load(path).isCompressed());
  saveWithoutTile("1");
  test::expectComplaint(test::complaintOf([&] { load(path); }), path, {"damaged", "(500, 0, 0)", "missing"});
}

TEST_F(MapFile, AsPcdGivesBackACompressedMapButForFloats) {
  const GaussianMapOctree map = thinned(refine<3>(build<3>(randomCloud<3>(3000, 29), {0.1, 3, 3, 0.0})).map);
  const auto path = directory_.path() / "small.pcd";
  savePcd(path, map);
  const GaussianMapOctree got = loadPcd(path);
  EXPECT_TRUE(got.isCompressed());
  EXPECT_FALSE(got.acceptsScans());
  for (int s = 0; s < 3; ++s) {
    EXPECT_EQ(got.scale(s).keys, map.scale(s).keys);
    EXPECT_EQ(got.scale(s).first_child, map.scale(s).first_child);
    EXPECT_TRUE(test::sameRanges<3>(got, map, s));
    EXPECT_NEAR(got.weight(s), map.weight(s), 1e-6 * map.weight(s));
  }
  EXPECT_EQ(leaves<3>(got), leaves<3>(map));
}

TEST_F(MapFile, AsPcdWithoutItsFinestScaleIsACoarserMap) {
  const GaussianMapOctree map = bare(refine<3>(build<3>(randomCloud<3>(500, 30), {0.1, 3, 3, 0.0})).map);
  const auto path = directory_.path() / "bare.pcd";
  savePcd(path, map);
  const GaussianMapOctree got = loadPcd(path);
  EXPECT_EQ(got.scales(), 1);
  EXPECT_EQ(got.gaussianCount(0), map.gaussianCount(2));
}

}  // namespace
}  // namespace gaussmap
