// SPDX-License-Identifier: BSD-3-Clause
// Map files: what goes in comes out.
#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

/// The same Gaussians at the finest scale, but no moments to grow from.
template <int D>
GaussianMap<D> finalised(const GaussianMap<D>& map) {
  MapScale<D> finest;
  finest.keys = map.scale(0).keys;
  for (std::size_t i = 0; i < map.gaussianCount(0); ++i) finest.gaussians.push_back(map.localGaussian(i, 0));
  return build<D>(finest, map.options());
}

template <int D>
std::vector<Vector<D>> shifted(std::vector<Vector<D>> points, double shift) {
  for (Vector<D>& point : points)
    for (int axis = 0; axis < D; ++axis) point(axis) += axis % 2 == 0 ? shift : -shift;
  return points;
}

TEST_F(MapFile, GivesBackEveryBitInSpace) {
  for (const int ratio : {2, 3, 10}) {
    const GaussianMapOctree map = build<3>(randomCloud<3>(3000, 21), {0.1, ratio, 3, 0.004});
    expectRoundTrip<3>(map);
    expectRoundTrip<3>(refined<3>(map));
    expectRoundTrip<3>(finalised<3>(map));
    expectRoundTrip<3>(refined<3>(finalised<3>(map)));
  }
}

TEST_F(MapFile, GivesBackEveryBitInThePlane) {
  for (const int ratio : {2, 3, 10}) {
    const GaussianMapQuadtree map = build<2>(randomCloud<2>(3000, 22), {0.07, ratio, 4, 0.0});
    expectRoundTrip<2>(map);
    expectRoundTrip<2>(refined<2>(map));
    expectRoundTrip<2>(finalised<2>(map));
  }
}

TEST_F(MapFile, GivesBackMapsOfOneScaleOnePointAndNothing) {
  expectRoundTrip<3>(build<3>(randomCloud<3>(500, 23), {0.1, 10, 1, 0.0}));
  expectRoundTrip<3>(build<3>({{-0.05, 7.3, -1e-9}}, {0.1, 10, 3, 0.0}));
  expectRoundTrip<3>(GaussianMapOctree({0.3, 7, 4, 0.01}));
  expectRoundTrip<2>(GaussianMapQuadtree({0.3, 2, 9, 0.0}));
  expectRoundTrip<3>(GaussianMapOctree({0.3, 2, 1, 0.0}));
}

TEST_F(MapFile, GivesBackNegativeAndFarCells) {
  for (const double shift : {-50.0, 1e7, -1e7}) {
    const GaussianMapOctree map = build<3>(shifted<3>(randomCloud<3>(1000, 24), shift), {0.1, 10, 3, 0.0});
    expectRoundTrip<3>(map);
    expectRoundTrip<3>(refined<3>(map));
  }
}

TEST_F(MapFile, GivesBackTheOutermostCells) {  // keys -2^31 and 2^31 - 1
  expectRoundTrip<3>(
      build<3>({{-2147483648.0, 2147483647.5, 0.0}, {2147483647.5, -2147483648.0, 1.0}}, {1.0, 10, 3, 0.0}));
}

TEST_F(MapFile, GivesBackALatticeThatCompressesToAlmostNothing) {  // one point in the middle of every cell
  std::vector<Vector<3>> points;
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 100; ++y)
      for (int z = 0; z < 10; ++z) points.emplace_back(x + 0.5, y + 0.5, z + 0.5);
  const GaussianMapOctree map = build<3>(points, {1.0, 10, 2, 0.0});
  ASSERT_EQ(map.cellCount(0), 100000u);
  for (const int level : {1, 3, 19}) {
    const fs::path path = directory_.path() / "lattice.gmap";
    save(path, map, {}, {true, level, 0});
    expectSameMap<3>(load(path), map);
  }
}

TEST_F(MapFile, SaysHowLargeItsPartsAre) {
  const fs::path path = directory_.path() / "map.gmap";
  save(path, smallMap());
  const MapFileSize size = mapFileSize(path);
  EXPECT_EQ(size.file, fs::file_size(path));
  ASSERT_EQ(size.scale_tiles.size(), 3u);
  std::uintmax_t tiles = 0;
  for (const std::uintmax_t bytes : size.scale_tiles) {
    EXPECT_GT(bytes, 0u);
    tiles += bytes;
  }
  EXPECT_LT(tiles, size.file);
}

}  // namespace
}  // namespace gaussmap::test
