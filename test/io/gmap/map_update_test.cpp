// SPDX-License-Identifier: BSD-3-Clause
#include "gaussmap/io/gmap/map_update.h"

#include <cmath>

#include "gaussmap/editing/compress.h"
#include "io/gmap/map_file_fixture.h"
#include "map/inherit_occupancy.h"

namespace gaussmap::test {
using namespace detail;

namespace {

namespace fs = std::filesystem;

template <int D>
MomentGrid<D> gridOf(const std::vector<Vector<D>>& points, double resolution) {
  MomentGrid<D> grid(resolution);
  grid.addPoints(points);
  return grid;
}

template <int D>
std::vector<Vector<D>> joined(std::vector<Vector<D>> a, const std::vector<Vector<D>>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// All tiles of a file, address and bytes.
std::string tilesIn(const fs::path& path) {
  return shell(path,
               "SELECT group_concat(scale||','||x||','||y||','||z||','||cells||','||gaussians||':'||hex(data), ';') "
               "FROM (SELECT * FROM tiles ORDER BY scale, x, y, z)")
      .at(0);
}

class MapUpdateFile : public MapFile {
 protected:
  fs::path path() const { return directory_.path() / "map.gmap"; }

  template <int D>
  GaussianMap<D> updated(const GaussianMap<D>& map, const std::vector<Vector<D>>& points,
                         const UpdateOptions& options = {}) {
    save<D>(path(), map, {}, {true, 3, 0});
    updateMap<D>(path(), gridOf<D>(points, map.options().resolution), options);
    return load<D>(path());
  }
};

TEST_F(MapUpdateFile, IsTheMapBuiltAtOnce) {
  for (const int ratio : {2, 3, 10})
    for (const int scales : {1, 3, 6}) {
      if (ratio == 10 && scales == 6) continue;
      const MapOptions options{0.04, ratio, scales, 0.0};
      for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{1500}}) {
        const auto old = randomCloud<3>(first, 81), added = randomCloud<3>(400, 82);
        const GaussianMapOctree at_once = build<3>(joined<3>(old, added), options);
        EXPECT_TRUE(sameMap<3>(updated<3>(build<3>(old, options), added), at_once)) << ratio << ", " << scales;
        const std::string tiles = tilesIn(path());
        save(path(), at_once, {}, {true, 3, 0});
        EXPECT_EQ(tilesIn(path()) == tiles, true) << ratio << ", " << scales;  // byte for byte
      }
    }
  const auto old = randomCloud<2>(1500, 83), added = randomCloud<2>(300, 84);
  const MapOptions plane{0.02, 4, 4, 0.0};
  EXPECT_TRUE(sameMap<2>(updated<2>(build<2>(old, plane), added), build<2>(joined<2>(old, added), plane)));
}

TEST_F(MapUpdateFile, IsTheSameForAnySplitIntoUpdates) {
  const MapOptions options{0.05, 5, 3, 0.0};
  Random random(85);
  const auto points = randomCloud<3>(2000, 86);
  save(path(), GaussianMapOctree(options));
  for (std::size_t first = 0, last = 0; first < points.size(); first = last) {
    last = std::min(points.size(), first + 1 + random.below(700));
    updateMap<3>(path(), gridOf<3>({points.begin() + long(first), points.begin() + long(last)}, 0.05));
  }
  expectSameMap<3>(load(path()), build<3>(points, options));
}

TEST_F(MapUpdateFile, OfARefinedMapIsRefinedAsAWholeWhereAllOfItChanges) {
  const MapOptions options{0.05, 5, 3, 0.0};
  const auto points = randomCloud<3>(3000, 87);
  const GaussianMapOctree old = refined<3>(build<3>(points, options));
  UpdateOptions update;
  update.budget = 2.5;  // that of refined()
  expectSameMap<3>(updated<3>(old, points, update), refined<3>(build<3>(joined<3>(points, points), options)));
}

TEST_F(MapUpdateFile, OfARefinedMapLeavesCellsWithoutNewPointsAsTheyAre) {
  const MapOptions options{0.02, 5, 3, 0.0};
  const auto points = randomCloud<3>(6000, 88);
  std::vector<Vector<3>> added;  // in one corner and beyond
  for (const Vector<3>& point : randomCloud<3>(2000, 89)) added.push_back(0.3 * point + Vector<3>(1, 1, 1));
  const GaussianMapOctree old = refined<3>(build<3>(points, options)), now = updated<3>(old, added);
  const GaussianMapOctree at_once = build<3>(joined<3>(points, added), options);
  EXPECT_TRUE(now.scale(0).keys == at_once.scale(0).keys && now.scale(0).moments == at_once.scale(0).moments);
  const GaussianMapOctree touched = build<3>(added, options);
  for (int s = 1; s < 3; ++s) {
    EXPECT_EQ(now.scale(s).keys, at_once.scale(s).keys);
    EXPECT_EQ(now.weight(s), at_once.weight(s));
    const double budget = double(old.gaussianCount(s)) / double(old.cellCount(s));
    EXPECT_EQ(now.gaussianCount(s), std::size_t(std::floor(budget * double(now.cellCount(s)) * (1 + 1e-9))));
    std::size_t kept = 0, gained = 0;
    for (std::size_t cell = 0; cell < now.cellCount(s); ++cell) {
      const CellKey<3>& key = now.scale(s).keys[cell];
      const IndexRange range = now.gaussiansOf(cell, s);
      if (touched.find(key, s)) {
        gained += range.size() > 1;
        continue;
      }
      const IndexRange before = old.gaussiansOf(*old.find(key, s), s);
      ASSERT_EQ(range.size(), before.size());
      for (std::size_t i = 0; i < range.size(); ++i)
        EXPECT_TRUE(sameGaussian<3>(now.localGaussian(range.first + i, s), old.localGaussian(before.first + i, s)));
      ++kept;
    }
    EXPECT_GT(kept, 0u);
    EXPECT_GT(gained, 0u);
  }
}

TEST_F(MapUpdateFile, WritesOnlyTheTilesThatChange) {
  const MapOptions options{0.1, 4, 2, 0.0};  // tiles of 6.4 and 25.6 m
  std::vector<Vector<3>> points;
  for (int i = 0; i < 400; ++i) points.emplace_back(0.5 * i + 0.25, 0.05, 0.05);
  save(path(), build<3>(points, options), {{"history", "[]"}});
  shell(path(), "UPDATE tiles SET cells = 12345");  // nobody reads it, so it marks the rows that stay
  const MapUpdate update =
      updateMap<3>(path(), gridOf<3>({{100.01, 0.05, 0.05}, {100.05, 0.05, 0.06}}, 0.1), {}, [](MapMetadata& metadata) {
        EXPECT_EQ(metadata.at("history"), "[]");
        metadata["history"] = "[1]";
        metadata["new"] = "x";
      });
  EXPECT_EQ(update.tiles_written, 2u);
  EXPECT_EQ(update.tiles, std::size_t(32 + 8));
  EXPECT_EQ(shell(path(), "SELECT COUNT(*) FROM tiles WHERE cells <> 12345").at(0), "2");
  points.emplace_back(100.01, 0.05, 0.05);
  points.emplace_back(100.05, 0.05, 0.06);
  const GaussianMapOctree now = load(path());
  expectSameMap<3>(now, build<3>(points, options));
  EXPECT_EQ(update.cells, (std::vector<std::size_t>{now.cellCount(0), now.cellCount(1)}));
  EXPECT_EQ(update.gaussians, (std::vector<std::size_t>{now.gaussianCount(0), now.gaussianCount(1)}));
  EXPECT_EQ(loadMetadata(path()), (MapMetadata{{"history", "[1]"}, {"new", "x"}}));
  EXPECT_EQ(shell(path(), "PRAGMA integrity_check").at(0), "ok");
  EXPECT_EQ(namesInFolder(), std::vector<std::string>{"map.gmap"});
}

TEST_F(MapUpdateFile, OfNothingIsTheSameMap) {
  save(path(), smallMap());
  EXPECT_EQ(updateMap<3>(path(), MomentGrid<3>(0.1)).tiles_written, 0u);
  expectSameMap<3>(load(path()), smallMap());
}

TEST_F(MapUpdateFile, HasTheSameBytesForAnyNumberOfThreads) {
  std::vector<std::string> files;
  for (const int threads : {1, 2, 0}) {
    UpdateOptions options;
    options.threads = threads;
    updated<3>(smallMap(), randomCloud<3>(300, 90), options);
    files.push_back(contentsOf(path()));
  }
  for (const std::string& file : files) EXPECT_TRUE(file == files.front());
}

TEST_F(MapUpdateFile, KeepsOccupanciesAndTakesNewCellsForCertain) {
  const MapOptions options{0.05, 5, 3, 0.0};
  const auto points = randomCloud<3>(1000, 91), added = randomCloud<3>(300, 92);
  const GaussianMapOctree plain = refined<3>(build<3>(points, options));
  std::vector<float> log_odds;
  Random random(93);
  for (std::size_t i = 0; i < plain.gaussianCount(0); ++i)
    log_odds.push_back(static_cast<float>(8.0 * random.uniform() - 4.0));
  const GaussianMapOctree old = withOccupancy<3>(plain, log_odds), now = updated<3>(old, added);
  ASSERT_TRUE(now.hasOccupancy());
  std::vector<float> expected;
  for (const CellKey<3>& key : now.scale(0).keys) {
    const auto before = old.find(key, 0);
    expected.push_back(before ? old.logOdds(*before, 0) : kMaxOccupancy);
  }
  EXPECT_EQ(now.scale(0).log_odds, expected);
  expectSameMap<3>(withOccupancy<3>(now, expected), now);  // above, what follows from them
  EXPECT_TRUE(updated<3>(withOccupancy<3>(plain, log_odds), {{50.0, 50.0, 50.0}}).hasOccupancy());  // all of it new
}

TEST_F(MapUpdateFile, TakesPointsFarAway) {
  const MapOptions options{0.1, 10, 3, 0.0};
  const std::vector<Vector<3>> points = {{0, 0, 0}, {1e7, -1e7, 3}}, added = {{2e8, -2e8, 2e8}, {1e7, -1e7, 3.01}};
  expectSameMap<3>(updated<3>(build<3>(points, options), added), build<3>(joined<3>(points, added), options));
  const MapOptions wide{1.0, 10, 5, 0.0};
  const std::vector<Vector<3>> outermost = {{-2147483648.0, 2147483647.5, 0.0}, {2147483647.5, -2147483648.0, 1.0}};
  expectSameMap<3>(updated<3>(build<3>(outermost, wide), outermost), build<3>(joined<3>(outermost, outermost), wide));
}

TEST_F(MapUpdateFile, IsRefusedWithAReasonAndLeavesTheFile) {
  const MomentGrid<3> added = gridOf<3>(randomCloud<3>(50, 94), 0.1);
  EXPECT_THROW(updateMap<3>(path(), added), FileError);
  EXPECT_THROW(updateMap<3>(directory_.write("text", "no map"), added), FileError);
  GaussianMapOctree map = smallMap();
  save(path(), map);
  EXPECT_THROW(updateMap<3>(path(), gridOf<3>({{0, 0, 0}}, 0.2)), std::invalid_argument);
  UpdateOptions low;
  low.budget = 0.5;
  EXPECT_THROW(updateMap<3>(path(), added, low), std::invalid_argument);
  EXPECT_THROW(updateMap<2>(path(), MomentGrid<2>(0.1)), FileError);
  expectSameMap<3>(load(path()), map);

  const GaussianMapOctree small = compress(map, 0.2);
  ASSERT_TRUE(small.isCompressed());
  save(path(), small, {}, {true, 3, 0});
  expectComplaint(complaintOf([&] { updateMap<3>(path(), added); }), path(), {"accepts no more scans"});
  MapScale<3> finest;
  finest.keys = {{0, 0, 0}};
  finest.gaussians = {{{0, 0, 0}, 1e-4 * Matrix<3>::Identity(), 5.0}};
  save(path(), build<3>(finest, {0.1, 4, 3, 0.0}), {}, {true, 3, 0});
  expectComplaint(complaintOf([&] { updateMap<3>(path(), added); }), path(), {"accepts no more scans"});
  EXPECT_EQ(namesInFolder(), (std::vector<std::string>{"map.gmap", "text"}));
}

TEST_F(MapUpdateFile, OfADamagedFileIsRefusedOrHarmless) {
  save(path(), smallMap());
  const std::string good = contentsOf(path());
  const MomentGrid<3> added = gridOf<3>(randomCloud<3>(60, 95), 0.1);
  Random random(96);
  int refused = 0;
  for (int round = 0; round < 500; ++round) {
    const std::string bytes = mutated(good, random);
    directory_.write("map.gmap", bytes);
    try {
      updateMap<3>(path(), added);
    } catch (const FileError&) {
      ++refused;
      EXPECT_TRUE(contentsOf(path()) == bytes) << "round " << round;
    }
    EXPECT_EQ(namesInFolder(), std::vector<std::string>{"map.gmap"});
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace gaussmap::test
