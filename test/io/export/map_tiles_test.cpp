// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/export/map_tiles.h"

#include <cmath>

#include "gaussmap/io/pcd/map_pcd.h"
#include "gaussmap/io/pcd/pcd_writer.h"
#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

std::vector<Vector<3>> spreadCloud() {
  std::vector<Vector<3>> points = randomCloud<3>(1500, 161);
  for (Vector<3>& point : points) point = 20.0 * point + Vector<3>(7.0, -3.0, 0.0);
  return points;
}

void expectClose(const GaussianMapOctree& a, const GaussianMapOctree& b, int s) {
  ASSERT_EQ(a.scale(s).keys, b.scale(s).keys);
  ASSERT_EQ(a.gaussianCount(s), b.gaussianCount(s));
  for (std::size_t i = 0; i < a.gaussianCount(s); ++i) {
    EXPECT_TRUE(a.localGaussian(i, s).mean.isApprox(b.localGaussian(i, s).mean, 1e-3));
    EXPECT_TRUE(a.localGaussian(i, s).cov.isApprox(b.localGaussian(i, s).cov, 1e-4));
    EXPECT_EQ(a.localGaussian(i, s).weight, b.localGaussian(i, s).weight);
  }
}

class MapTiles : public MapFile {
 protected:
  fs::path folder() const { return directory_.path() / "tiles"; }
};

TEST_F(MapTiles, AreSquaresWithAnIndexOfTheirLowerCorners) {
  const GaussianMapOctree map =
      build<3>({{-0.05, 0.05, 0.05}, {19.95, 0.05, 3.0}, {20.05, -0.05, 0.0}, {20.06, -0.06, 0.0}}, {0.1, 10, 2, 0.0});
  const WrittenTiles written = saveTiles(folder(), map);
  EXPECT_EQ(written.tiles, 3u);
  EXPECT_EQ(written.gaussians, 3u);
  EXPECT_EQ(contentsOf(folder() / kTilesIndex),
            "# gaussmap: resolution 0.1 ratio 10 scales 2 noise 0.005\n"
            "x_resolution: 20.0\ny_resolution: 20.0\n"
            "tile_-20_0.pcd: [-20, 0]\ntile_0_0.pcd: [0, 0]\ntile_20_-20.pcd: [20, -20]\n");
  const GaussianRecords tile = loadRecordsPcd(folder() / "tile_20_-20.pcd");
  ASSERT_EQ(tile.records.size(), 1u);
  EXPECT_EQ(tile.records[0].weight, 2.0f);
  EXPECT_NEAR(tile.records[0].mean[0], 20.055f, 1e-5f);
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"tiles"});
}

TEST_F(MapTiles, HoldEveryGaussianOnceInItsSquare) {
  const GaussianMapOctree map = refined<3>(build<3>(spreadCloud(), {0.5, 4, 3, 0.0}));
  TilesOptions options;
  options.size = 7;
  options.scale = std::nullopt;
  const WrittenTiles written = saveTiles(folder(), map, options);
  std::size_t found = 0, tiles = 0;
  for (const auto& entry : fs::directory_iterator(folder())) {
    if (entry.path().extension() != ".pcd") continue;
    ++tiles;
    int x = 0, y = 0;
    ASSERT_EQ(std::sscanf(entry.path().filename().c_str(), "tile_%d_%d.pcd", &x, &y), 2);
    EXPECT_EQ(x % 7, 0);
    for (const GaussianRecord& record : loadRecordsPcd(entry.path()).records) {
      EXPECT_TRUE(record.mean[0] >= float(x) && record.mean[0] < float(x + 7));
      EXPECT_TRUE(record.mean[1] >= float(y) && record.mean[1] < float(y + 7));
      ++found;
    }
  }
  EXPECT_EQ(found, map.gaussianCount(0) + map.gaussianCount(1) + map.gaussianCount(2));
  EXPECT_EQ(written.gaussians, found);
  EXPECT_EQ(written.tiles, tiles);
}

TEST_F(MapTiles, OfTheFinestScaleBecomeAMapOfAllScales) {
  const GaussianMapOctree map = build<3>(spreadCloud(), {0.5, 4, 3, 0.03});
  saveTiles(folder(), map);
  const GaussianMapOctree back = loadTiles(folder());
  EXPECT_EQ(back.options(), map.options());
  for (int s = 0; s < 3; ++s) expectClose(map, back, s);
  EXPECT_FALSE(back.acceptsScans());
}

TEST_F(MapTiles, OfAllScalesBecomeTheMap) {
  const GaussianMapOctree map = refined<3>(build<3>(spreadCloud(), {0.5, 4, 3, 0.0}));
  TilesOptions options;
  options.scale = std::nullopt;
  saveTiles(folder(), map, options);
  const GaussianMapOctree back = loadTiles(folder());
  expectClose(map, back, 0);
  for (int s = 1; s < 3; ++s) {
    EXPECT_EQ(back.scale(s).keys, map.scale(s).keys);
    EXPECT_EQ(back.gaussianCount(s), map.gaussianCount(s));
  }
}

TEST_F(MapTiles, AreReadWithoutTheComment) {
  saveTiles(folder(), build<3>(spreadCloud(), {0.5, 4, 3, 0.0}));
  const std::string index = contentsOf(folder() / kTilesIndex);
  directory_.write("tiles/" + std::string(kTilesIndex), "\r\n" + index.substr(index.find('\n') + 1) + "# end\n");
  EXPECT_EQ(loadTiles(folder()).scales(), 1);
}

TEST_F(MapTiles, AreRefusedWithAReason) {
  const GaussianMapOctree map = smallMap();
  TilesOptions none;
  none.size = 0;
  EXPECT_THROW(saveTiles(folder(), map, none), std::invalid_argument);
  none = {};
  none.scale = 3;
  EXPECT_THROW(saveTiles(folder(), map, none), std::out_of_range);
  EXPECT_THROW(saveTiles(folder(), build<3>({{3e9, 0, 0}}, {10.0, 4, 2, 0.0})), std::out_of_range);
  EXPECT_TRUE(namesInFolder().empty());
  fs::create_directory(folder());
  saveTiles(folder(), map);  // an empty one is taken
  EXPECT_THROW(saveTiles(folder(), map), FileError);
  const std::string index = contentsOf(folder() / kTilesIndex);
  const auto refused = [&](const std::string& text, const std::string& why) {
    directory_.write("tiles/" + std::string(kTilesIndex), text);
    expectComplaint(complaintOf([&] { loadTiles(folder()); }), folder() / kTilesIndex, {why});
  };
  refused("", "x_resolution");
  refused("x_resolution: 20.0\ny_resolution: nan\n", "not a positive number");
  refused("x_resolution: 20.0\ny_resolution: 20.0\n", "names no tile");
  refused("x_resolution: 20.0\ny_resolution: 20.0\n../secret.pcd: [0, 0]\n", "not a file in the same folder");
  directory_.write("tiles/" + std::string(kTilesIndex), "x_resolution: 1\ny_resolution: 1\nnone.pcd: [0, 0]\n");
  EXPECT_THROW(loadTiles(folder()), FileError);
  writePcd(folder() / "points.pcd", std::vector<Vector<3>>{{1, 2, 3}});
  directory_.write("tiles/" + std::string(kTilesIndex), "x_resolution: 1\ny_resolution: 1\npoints.pcd: [0, 0]\n");
  expectComplaint(complaintOf([&] { loadTiles(folder()); }), folder() / "points.pcd", {"holds points"});
  EXPECT_THROW(loadTiles(directory_.path() / "nowhere"), FileError);
  Random random(162);
  for (int round = 0; round < 300; ++round) {
    directory_.write("tiles/" + std::string(kTilesIndex), mutated(index, random));
    try {
      EXPECT_FALSE(loadTiles(folder()).empty());
    } catch (const FileError&) {
    }
  }
}

}  // namespace
}  // namespace gaussmap::test
