// SPDX-License-Identifier: BSD-3-Clause
// Planar map files that are built within limited memory, updated, and read box by box.
#include "gaussmap/io/gmap/build_map_file.h"
#include "gaussmap/io/gmap/map_reader.h"
#include "gaussmap/io/gmap/map_update.h"
#include "gaussmap/map/queries.h"
#include "io/gmap/map_file_fixture.h"

namespace gaussmap::test {
namespace {

namespace fs = std::filesystem;

MemoryScans scansWithHeight() {
  MemoryScans scans;
  for (std::uint64_t i = 0; i < 5; ++i) {
    Pose pose;
    pose.translation = {0.4 * double(i), -0.2 * double(i), 1.0};
    scans.add({randomCloud<3>(12000, 400 + i), pose, 0, std::nullopt});
  }
  return scans;
}

class PlanarMapFile : public MapFile {};

TEST_F(PlanarMapFile, BuiltInPartsHasTheBytesOfTheMapBuiltInMemory) {
  const MemoryScans scans = scansWithHeight();
  const MapOptions options{0.004, 4, 4, 0.0};
  AccumulateOptions reading;
  reading.resolution = options.resolution;
  reading.crop = Box<3>{{-20, -20, 0.2}, {20, 20, 1.8}};
  const MapMetadata metadata = {{"history", "[]"}};
  for (const double budget : {1.0, 2.5}) {
    const fs::path expected = directory_.path() / "expected.gmap", path = directory_.path() / "map.gmap";
    const AccumulatedScans<2> all = accumulateScans<2>(scans, reading);
    save(expected, refine<2>(build<2>(all.moments, options), PerCell{budget}).map, metadata, {true, 3, 0});
    BuildMapFileOptions building;
    building.max_memory = kMinBuildMemory;
    building.budget = PerCell{budget};
    building.save = {true, 3, 0};
    const BuiltMapFile built = buildMapFile<2>(
        scans, reading, options, path, [&](const PointCounts&) { return metadata; }, building);
    EXPECT_EQ(built.counts.accepted, all.counts.accepted);
    EXPECT_GT(built.counts.outside, 0);
    EXPECT_EQ(built.cells.front(), all.moments.size());
    EXPECT_EQ(mapDimensions(path), 2);
    EXPECT_TRUE(contentsOf(path) == contentsOf(expected));
  }
}

TEST_F(PlanarMapFile, GrowsAndIsReadBoxByBox) {
  const MapOptions options{0.01, 4, 3, 0.0};
  const auto old = randomCloud<2>(2000, 1), added = randomCloud<2>(500, 2);
  const fs::path path = directory_.path() / "map.gmap";
  save(path, build<2>(old, options));
  MomentGrid<2> sums(0.01);
  sums.addPoints(added);
  UpdateOptions update;
  update.budget = 1.0;
  updateMap<2>(path, sums, update);
  std::vector<Vector<2>> all = old;
  all.insert(all.end(), added.begin(), added.end());
  const GaussianMap<2> expected = build<2>(all, options);
  expectSameMap<2>(load<2>(path), expected);

  MapReader<2> reader(path);
  const Box<2> box{{-0.5, -0.5}, {0.5, 0.5}};
  const GaussianMap<2> part = reader.load(box);
  EXPECT_GT(part.cellCount(0), 0u);
  EXPECT_LT(part.cellCount(0), expected.cellCount(0));
  std::size_t inside = 0;
  for (const Vector<2>& point : all) {
    if (!isInBox(box, point)) continue;
    ++inside;
    const CellKey<2> key = expected.grid().keyOf(point);
    const auto cell = part.find(key, 0);
    ASSERT_TRUE(cell);
    EXPECT_EQ(part.scale(0).moments[*cell], expected.scale(0).moments[*expected.find(key, 0)]);
  }
  EXPECT_GT(inside, 100u);
  const LeafCounts counts = leafCounts(expected, 0);
  EXPECT_EQ(counts.cells, expected.cellCount(0));
  EXPECT_EQ(counts.weight, 2500.0);
  const Box<2> extent = *extentOf(expected);
  for (const Vector<2>& point : all) EXPECT_TRUE(isInBox(extent, point));
}

}  // namespace
}  // namespace gaussmap::test
