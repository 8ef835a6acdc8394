// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/online/online_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "gaussmap/core/gaussian.h"

namespace gaussmap {
using namespace detail;

namespace {

using Cells = OnlineCells<3>;

Grid<3> grid() {
  return Grid<3>({0.5, 2, 3, 0.0});
}

/// Adds a finest cell with a cluster of one point at its centre. Cells above it get a cluster if they have no cluster
/// yet.
std::uint32_t occupy(Cells& cells, const CellKey<3>& key) {
  std::uint32_t child = cells.findOrInsert(key);
  const std::uint32_t finest = child;
  for (int scale = 0; scale < cells.scales() && cells.cell(child, scale).clusters.empty(); ++scale) {
    OnlineCluster<3> cluster;
    cluster.gaussian.weight = 1.0;
    cells.addCluster(child, scale, cluster);
    child = cells.cell(child, scale).parent;
  }
  if (cells.scales() > 1) cells.markStale(cells.cell(finest, 0).parent, 1);
  return finest;
}

const auto kNobody = [](std::uint32_t, std::size_t, int) {};

TEST(OnlineCells, KeepEveryAncestorAsLongAsACellIsUnderItWhateverComesAndGoes) {
  Cells cells(grid());
  Random random(3);
  std::set<CellKey<3>> twin;
  for (int step = 0; step < 3000; ++step) {
    const auto coordinate = [&] { return static_cast<std::int32_t>(random.bits() % 8) - 4; };
    const CellKey<3> key = {coordinate(), coordinate(), coordinate()};
    if (twin.erase(key) > 0) {
      cells.erase(cells.find(key, 0), kNobody);
    } else {
      occupy(cells, key);
      twin.insert(key);
    }
  }
  for (int scale = 0; scale < 3; ++scale) {
    std::set<CellKey<3>> ancestors;
    for (const CellKey<3>& key : twin) ancestors.insert(cells.grid().ancestor(key, 0, scale));
    EXPECT_EQ(cells.size(scale), ancestors.size());
    std::size_t children = 0;
    for (const CellKey<3>& key : ancestors) {
      const std::uint32_t i = cells.find(key, scale);
      ASSERT_NE(i, Cells::kNone);
      EXPECT_EQ(cells.cell(i, scale).key, key);
      children += cells.cell(i, scale).children.size();
      for (const std::uint32_t child : cells.cell(i, scale).children) EXPECT_EQ(cells.cell(child, scale - 1).parent, i);
    }
    EXPECT_EQ(children, scale > 0 ? cells.size(scale - 1) : 0u);
  }
  // The weights of every scale add up once they are summed again.
  double weight = 0.0;
  for (std::uint32_t i = 0; i < cells.slots(2); ++i) {
    if (!cells.cell(i, 2).alive) continue;
    cells.refresh(i, 2);
    for (const OnlineCluster<3>& cluster : cells.cell(i, 2).clusters) weight += cluster.gaussian.weight;
  }
  EXPECT_DOUBLE_EQ(weight, double(twin.size()));
  EXPECT_LE(cells.slots(0), 8u * 8u * 8u);  // places of erased cells are used again
}

TEST(OnlineCells, ForgetWhatACellThatLostAClusterCouldGainOrLose) {
  Cells cells(grid());
  const std::uint32_t left = occupy(cells, {0, 0, 0}), right = occupy(cells, {1, 0, 0});
  const std::uint32_t parent = cells.cell(left, 0).parent;
  ASSERT_EQ(cells.cell(right, 0).parent, parent);
  cells.addCluster(parent, 1, cells.cell(parent, 1).clusters[0]);
  cells.cell(right, 0).clusters[0].parent = 1;
  cells.cell(parent, 1).need = cells.cell(parent, 1).spare = 1.0;
  std::vector<int> gone;
  cells.erase(left, [&](std::uint32_t, std::size_t, int scale) { gone.push_back(scale); });
  EXPECT_EQ(gone, (std::vector<int>{0, 1}));
  EXPECT_EQ(cells.cell(parent, 1).clusters.size(), 1u);
  EXPECT_EQ(cells.cell(right, 0).clusters[0].parent, 0u);
  EXPECT_EQ(cells.cell(parent, 1).need, 0.0);
  EXPECT_EQ(cells.cell(parent, 1).spare, 0.0);
}

}  // namespace
}  // namespace gaussmap
