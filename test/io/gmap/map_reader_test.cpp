// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/gmap/map_reader.h"

#include <cmath>
#include <limits>
#include <optional>

#include "editing/keep_cells.h"
#include "gaussmap/editing/compress.h"
#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
using namespace detail;

namespace {

namespace fs = std::filesystem;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Box<3> kEverything{Vector<3>::Constant(-kInfinity), Vector<3>::Constant(kInfinity)};

template <int D>
Box<D> randomBox(Random& random) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    const double a = 6.0 * random.uniform() - 3.0, b = 6.0 * random.uniform() - 3.0;
    box.low(axis) = std::min(a, b);
    box.high(axis) = random.below(5) == 0 ? kInfinity : std::max(a, b);
  }
  return box;
}

/// The brute-force twin of load(): looks at every cell of the whole map.
template <int D>
GaussianMap<D> partOf(const GaussianMap<D>& map, const Box<D>& box, int finest_scale) {
  const auto meets = [&](const CellKey<D>& key, int s) {
    for (int axis = 0; axis < D; ++axis) {
      const auto low = std::floor(box.low(axis) / map.grid().side(0)),
                 high = std::floor(box.high(axis) / map.grid().side(0));
      const double span = static_cast<double>(map.grid().cellsAlongSide(s));
      const double first = key[static_cast<std::size_t>(axis)] * span;
      if (high < first || low >= first + span) return false;
    }
    return true;
  };
  std::vector<std::vector<char>> keep(static_cast<std::size_t>(map.scales()));
  for (int s = 0; s < map.scales(); ++s) {
    std::vector<char>& kept = keep[static_cast<std::size_t>(s)];
    kept.assign(map.cellCount(s), 0);
    for (std::size_t cell = 0; s >= finest_scale && cell < map.cellCount(s); ++cell) {
      const IndexRange children = s > finest_scale ? map.childCells(cell, s) : IndexRange{};
      kept[cell] = children.empty() && meets(map.scale(s).keys[cell], s);
      for (std::size_t child = children.first; child < children.last; ++child)
        kept[cell] |= keep[static_cast<std::size_t>(s) - 1][child];
    }
  }
  return keepCells<D>(map, keep);
}

template <int D>
void expectParts(const GaussianMap<D>& map, const fs::path& path, std::uint64_t seed) {
  save<D>(path, map, {}, {true, 3, 0});
  for (const std::size_t cache : {std::size_t{0}, std::size_t{20000}, std::size_t{1} << 30}) {
    MapReader<D> reader(path, {cache, 0});
    Random random(seed);
    std::size_t cells = 0;
    for (int round = 0; round < 60; ++round) {
      const Box<D> box = randomBox<D>(random);
      const int scale = static_cast<int>(random.below(static_cast<std::uint64_t>(map.scales())));
      const GaussianMap<D> part = reader.load(box, scale);
      EXPECT_TRUE(sameMap<D>(part, partOf<D>(map, box, scale))) << "round " << round;
      cells += part.cellCount(scale);
    }
    EXPECT_GT(cells, 0u);
    EXPECT_LE(reader.statistics().cache_bytes, cache);
  }
}

TEST_F(MapFile, IsReadBoxByBoxAsItIsAsAWhole) {
  const fs::path path = directory_.path() / "map.gmap";
  for (const int ratio : {2, 3, 10}) {
    const GaussianMapOctree map = refined<3>(build<3>(randomCloud<3>(4000, 61), {0.03, ratio, 3, 0.0}));
    expectParts<3>(map, path, 62);
  }
  expectParts<2>(refined<2>(build<2>(randomCloud<2>(4000, 63), {0.01, 4, 4, 0.0})), path, 64);
  expectParts<3>(build<3>(randomCloud<3>(500, 65), {0.1, 10, 1, 0.0}), path, 66);
}

TEST_F(MapFile, OfACompressedMapIsReadBoxByBox) {
  const GaussianMapOctree map = compress(build<3>(randomCloud<3>(4000, 67), {0.03, 8, 3, 0.0}), 0.03);
  ASSERT_TRUE(map.isCompressed());
  ASSERT_GT(map.cellCount(0), 0u);
  expectParts<3>(map, directory_.path() / "map.gmap", 68);
}

TEST_F(MapFile, IsReadWholeThroughAnInfiniteBox) {
  const fs::path path = directory_.path() / "map.gmap";
  const GaussianMapOctree map = smallMap();
  save(path, map, {{"crs", "EPSG:25832"}});
  MapReader<3> reader(path);
  expectSameMap<3>(reader.load(kEverything), map);
  EXPECT_EQ(reader.metadata(), (MapMetadata{{"crs", "EPSG:25832"}}));
  EXPECT_EQ(reader.grid().options(), map.options());
  for (int s = 0; s < 3; ++s) {
    EXPECT_EQ(reader.cellCount(s), map.cellCount(s));
    EXPECT_EQ(reader.gaussianCount(s), map.gaussianCount(s));
  }
  const GaussianMapOctree nothing = reader.load({{1e7, 1e7, 1e7}, {1e8, 1e8, 1e8}});
  EXPECT_TRUE(nothing.empty());
  save(path, GaussianMapOctree({0.1, 4, 3, 0.0}), {}, {true, 3, 0});
  EXPECT_TRUE(MapReader<3>(path).load(kEverything).empty());
}

TEST_F(MapFile, IsReadBoxByBoxFarAway) {
  const fs::path path = directory_.path() / "map.gmap";
  std::vector<Vector<3>> points = randomCloud<3>(500, 69);
  for (Vector<3>& point : points) point += Vector<3>(1e7, -1e7, 5.0);
  points.emplace_back(2e8, -2e8, 0.0);
  const GaussianMapOctree map = build<3>(points, {0.1, 10, 3, 0.0});
  save(path, map);
  MapReader<3> reader(path);
  const Box<3> box{{1e7 - 1.0, -1e7 - 1.0, 4.0}, {1e7 + 1.0, -1e7 + 1.0, 6.0}};
  const GaussianMapOctree part = reader.load(box);
  EXPECT_FALSE(part.empty());
  expectSameMap<3>(part, partOf<3>(map, box, 0));
  expectSameMap<3>(reader.load(kEverything), map);
}

TEST_F(MapFile, IsReadTileByTileOnceCoarseScalesFirst) {
  const fs::path path = directory_.path() / "map.gmap";
  save(path, refined<3>(build<3>(randomCloud<3>(3000, 72), {0.02, 4, 3, 0.0})));
  const auto tilesOf = [&](int s) {
    return static_cast<std::size_t>(
        std::stoi(shell(path, "SELECT COUNT(*) FROM tiles WHERE scale = " + std::to_string(s)).at(0)));
  };
  MapReader<3> reader(path);
  EXPECT_EQ(reader.statistics().tiles_read, 0u);  // opening reads none
  std::size_t tiles = 0;
  for (int s = 2; s >= 0; --s) {
    reader.load(kEverything, s);
    tiles += tilesOf(s);
    EXPECT_EQ(reader.statistics().tiles_read, tiles);
  }
  reader.load(kEverything);
  EXPECT_EQ(reader.statistics().tiles_read, tiles);
  EXPECT_GE(reader.statistics().tiles_cached, tiles);
  EXPECT_GT(reader.statistics().cache_bytes, 0u);
  MapReader<3> corner(path);
  corner.load({{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}});
  EXPECT_LE(corner.statistics().tiles_read, 3u * 8u);
  EXPECT_LT(corner.statistics().tiles_read, tiles);
}

TEST_F(MapFile, ForgetsTheTilesThatWereUsedLongestAgo) {
  const fs::path path = directory_.path() / "map.gmap";
  std::vector<Vector<3>> points;  // three tiles of equal contents in a row: 64 cells of 0.1 m each
  for (int tile = 0; tile < 3; ++tile)
    for (int i = 0; i < 50; ++i) points.emplace_back(6.4 * tile + 0.05 + 0.1 * i, 0.05, 0.05);
  save(path, build<3>(points, {0.1, 4, 1, 0.0}));
  const auto box = [](int tile) { return Box<3>{{6.4 * tile + 0.01, 0, 0}, {6.4 * tile + 1.0, 1, 1}}; };
  MapReader<3> whole(path);
  whole.load(box(0));
  const std::size_t one = whole.statistics().cache_bytes;
  MapReader<3> reader(path, {2 * one, 1});
  for (const int tile : {0, 1, 0, 2}) reader.load(box(tile));  // 2 takes the place of 1
  EXPECT_EQ(reader.statistics().tiles_read, 3u);
  EXPECT_EQ(reader.statistics().cache_bytes, 2 * one);
  reader.load(box(0));
  EXPECT_EQ(reader.statistics().tiles_read, 3u);
  reader.load(box(1));
  EXPECT_EQ(reader.statistics().tiles_read, 4u);
}

TEST_F(MapFile, StaysTheOneThatWasOpenedUntilRefreshed) {
  const fs::path path = directory_.path() / "map.gmap";
  const GaussianMapOctree old = smallMap(), fresh = build<3>(randomCloud<3>(300, 70), {0.2, 3, 2, 0.0});
  save(path, old);
  MapReader<3> reader(path, {0, 0});
  EXPECT_FALSE(reader.refresh());
  save(path, fresh, {}, {true, 3, 0});
  expectSameMap<3>(reader.load(kEverything), old);
  EXPECT_TRUE(reader.refresh());
  expectSameMap<3>(reader.load(kEverything), fresh);
  fs::remove(path);
  EXPECT_THROW(reader.refresh(), FileError);
  expectSameMap<3>(reader.load(kEverything), fresh);
}

TEST_F(MapFile, IsRefusedByTheReaderWithAReason) {
  EXPECT_THROW(MapReader<3>(directory_.path() / "missing.gmap"), FileError);
  EXPECT_THROW(MapReader<3>(directory_.write("text", "no map")), FileError);
  const fs::path path = directory_.path() / "map.gmap";
  save(path, smallMap());
  EXPECT_THROW(MapReader<2>{path}, FileError);
  MapReader<3> reader(path);
  EXPECT_THROW(reader.load(kEverything, 3), std::out_of_range);
  EXPECT_THROW(reader.load(kEverything, -1), std::out_of_range);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(reader.load({{0, 0, 0}, {1, nan, 1}}), std::invalid_argument);
  EXPECT_THROW(reader.load({{0, 0, 0}, {1, -1, 1}}), std::invalid_argument);
  shell(path, "DELETE FROM tiles WHERE scale = 1");
  expectComplaint(complaintOf([&] { MapReader<3>(path).load(kEverything); }), path, {"is missing"});
}

TEST_F(MapFile, WithBytesChangedIsReadTheSameOrRefused) {
  const GaussianMapOctree map = smallMap();
  const fs::path path = directory_.path() / "map.gmap", changed = directory_.path() / "changed.gmap";
  save(path, map);
  const std::string good = contentsOf(path);
  Random random(71);
  const Box<3> box{{-1, -1, -1}, {0.3, 0.3, 0.3}};
  const GaussianMapOctree part = partOf<3>(map, box, 0);
  int refused = 0;
  for (int round = 0; round < 500; ++round) {
    directory_.write("changed.gmap", mutated(good, random));
    try {
      MapReader<3> reader(changed);
      const GaussianMapOctree got = reader.load(box);
      // A row that was lost is not seen by who reads only a part; what is there, is right.
      EXPECT_TRUE(got.weight(0) < part.weight(0) || sameMap<3>(got, part)) << "round " << round;
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace gaussmap::test
