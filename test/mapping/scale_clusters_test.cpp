// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/scale_clusters.h"

#include "clustering/merge_gains.h"
#include "map/occupied_areas.h"
#include "mapping/refine_helpers.h"

namespace gaussmap {
namespace {

/// The two finest scales of a room, the coarse one fresh from coarsen().
struct RoomScales {
  GaussianMap<3> map = roomMap(20000, 5, 2);
  MapScale<3> finer = map.scale(0);
  MapScale<3> coarse = coarsen(finer, map.grid(), 0);
  ScalePair<3> pair{finer, coarse, map.grid(), 0};
  std::vector<double> areas = finestAreas(finer);
  ScaleClusters clusters = ScaleClusters::under(pair, areas, MergeCost::Volume, 1);
};

TEST(ScaleClusters, GiveEveryCellThePartsThatPartsPerCellSays) {
  const RoomScales room;
  for (const std::size_t extra : {std::size_t{0}, std::size_t{17}, room.clusters.maxExtra() + 5}) {
    const ClusterCut cut = room.clusters.cut(extra);
    const std::vector<std::size_t> parts = partsPerCell(room.clusters.gains(), extra);
    ASSERT_EQ(cut.first.size(), parts.size() + 1);
    EXPECT_EQ(cut.clusters(), parts.size() + std::min(extra, room.clusters.maxExtra()));
    for (std::size_t cell = 0; cell < parts.size(); ++cell) {
      ASSERT_EQ(cut.first[cell + 1] - cut.first[cell], parts[cell]);
      const IndexRange under = room.pair.gaussiansUnder(cell);
      const std::vector<int> expected = labels(room.clusters.dendrograms()[cell], parts[cell]);
      for (std::size_t i = under.first; i < under.last; ++i)
        ASSERT_EQ(cut.cluster[i], cut.first[cell] + static_cast<std::uint32_t>(expected[i - under.first]));
    }
  }
}

TEST(ScaleClusters, AreTheSameFromTheirDendrograms) {
  const RoomScales room;
  const ScaleClusters again(room.clusters.dendrograms(), 2);
  EXPECT_EQ(again.gains(), room.clusters.gains());
  EXPECT_EQ(again.cut(40).cluster, room.clusters.cut(40).cluster);
}

TEST(ScaleClusters, ReplaceTheGaussiansByMomentMatches) {
  RoomScales room;
  const ClusterCut cut = room.clusters.cut(25);
  setClusters(room.pair, cut, 1);
  EXPECT_EQ(room.coarse.gaussians.size(), room.coarse.keys.size() + 25);
  EXPECT_EQ(room.coarse.first_gaussian, cut.first);
  EXPECT_EQ(room.finer.parent, cut.cluster);
  const GaussianMap<3> map(room.map.options(), {room.finer, room.coarse});
  EXPECT_NEAR(map.weight(1), map.weight(0), 1e-6);
}

TEST(ScaleClusters, WithinCellsLeaveThoseThatAreKeptAsTheyAre) {
  const GaussianMap<3> map = refine(roomMap(20000, 5, 2), PerCell{4.0}).map;
  const MapScale<3>& scale = map.scale(1);
  const std::vector<double> areas(scale.gaussianCount(), 1.0);
  std::vector<char> keep(scale.keys.size(), 0);
  for (std::size_t cell = 0; cell < keep.size(); cell += 3) keep[cell] = 1;
  const ClusterCut cut = ScaleClusters::within(scale, map.grid(), 1, areas, MergeCost::Volume, 2, keep).cut(4);
  std::size_t extra = 0;
  for (std::size_t cell = 0; cell < keep.size(); ++cell) {
    const std::size_t count = cut.first[cell + 1] - cut.first[cell];
    if (keep[cell])
      EXPECT_EQ(count, gaussiansOf(scale, cell).size());
    else
      extra += count - 1;
  }
  EXPECT_EQ(extra, 4u);
}

TEST(ScaleClusters, OnePerCellNumbersTheCells) {
  const GaussianMap<3> map = refine(roomMap(5000, 5, 2), PerCell{2.0}).map;
  const ClusterCut cut = onePerCell(map.scale(1));
  EXPECT_EQ(cut.clusters(), map.cellCount(1));
  for (std::size_t i = 0; i < cut.cluster.size(); ++i) EXPECT_EQ(cut.cluster[i], map.cellOf(i, 1));
  EXPECT_EQ(mergedAreas(std::vector<double>(cut.cluster.size(), 1.0), cut).front(),
            static_cast<double>(map.gaussiansOf(0, 1).size()));
}

}  // namespace
}  // namespace gaussmap
