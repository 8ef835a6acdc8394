// SPDX-License-Identifier: BSD-3-Clause
#include "map/member_boxes.h"

#include <gtest/gtest.h>

#include "gaussmap/editing/compress.h"
#include "gaussmap/mapping/build.h"
#include "gaussmap/mapping/refine.h"
#include "map/random_clouds.h"
#include "mapping/room.h"

namespace gaussmap {
using namespace detail;

namespace {

TEST(MemberBoxes, OfTwoCellsIsTheBoxAroundBoth) {
  const GaussianMapOctree map = build<3>({{0.05, 0.05, 0.05}, {0.35, 0.15, 0.05}}, {0.1, 10, 2, 0.0});
  const std::vector<Box<3>> boxes = memberBoxes<3>(map, 1);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_LT((boxes[0].low - Vector<3>(0, 0, 0)).norm(), 1e-12);
  EXPECT_LT((boxes[0].high - Vector<3>(0.4, 0.2, 0.1)).norm(), 1e-12);
}

TEST(MemberBoxes, HoldTheMeansOfAllDescendants) {
  const GaussianMapOctree map = refine<3>(build<3>(test::randomCloud<3>(3000, 41), {0.1, 4, 3, 0.0})).map;
  for (int s = 1; s < map.scales(); ++s) {
    const std::vector<Box<3>> boxes = memberBoxes<3>(map, s);
    ASSERT_EQ(boxes.size(), map.gaussianCount(s));
    for (std::size_t i = 0; i < map.gaussianCount(s - 1); ++i) {
      const Box<3>& box = boxes[map.parentOf(i, s - 1)];
      const Vector<3> mean = map.gaussian(i, s - 1).mean;
      EXPECT_TRUE((mean.array() >= box.low.array() - 1e-6).all() && (mean.array() <= box.high.array() + 1e-6).all());
    }
  }
}

template <int D>
void expectBox(const Box<D>& box, const Vector<D>& low, const Vector<D>& high) {
  EXPECT_LT((box.low - low).norm(), 1e-9) << box.low.transpose();
  EXPECT_LT((box.high - high).norm(), 1e-9) << box.high.transpose();
}

TEST(MemberBoxes, OfAClusterWithoutMembersIsItsCellAndCountsInTheScalesAbove) {
  // Cells of 1, 2 and 4 m. Both finest cells are linked to the first of the two clusters of their cell of 2 m.
  const Gaussian<2> gaussian{{0, 0}, 0.01 * Matrix<2>::Identity(), 1.0};
  MapScale<2> fine, middle, coarse;
  fine.keys = {{0, 0}, {1, 0}};
  fine.gaussians = {gaussian, gaussian};
  fine.parent = {0, 0};
  middle.keys = {{0, 0}};
  middle.first_child = {0, 2};
  middle.first_gaussian = {0, 2};
  middle.gaussians = {gaussian, gaussian};
  middle.parent = {0, 1};
  coarse.keys = {{0, 0}};
  coarse.first_child = {0, 1};
  coarse.first_gaussian = {0, 3};
  coarse.gaussians = {gaussian, gaussian, gaussian};
  const GaussianMapQuadtree map({1.0, 2, 3, 0.1}, {fine, middle, coarse});
  const std::vector<Box<2>> at_1 = memberBoxes<2>(map, 1), at_2 = memberBoxes<2>(map, 2);
  expectBox<2>(at_1[0], {0, 0}, {2, 1});
  expectBox<2>(at_1[1], {0, 0}, {2, 2});
  expectBox<2>(at_2[0], {0, 0}, {2, 1});
  expectBox<2>(at_2[1], {0, 0}, {2, 2});
  expectBox<2>(at_2[2], {0, 0}, {4, 4});
}

TEST(MemberBoxes, WhereDetailWasDeletedAreTheCellsThatStandThere) {
  Random random(43);
  const GaussianMapOctree map = refine<3>(build<3>(roomPoints(random, 20000), {0.1, 4, 4, 0.0})).map;
  const GaussianMapOctree thin = compress(map, 0.08);
  ASSERT_GT(thin.cellCount(0), 0u);
  ASSERT_LT(thin.cellCount(0), map.cellCount(0) / 2);
  std::size_t leaves = 0;
  for (int s = 1; s < map.scales(); ++s) {
    const std::vector<Box<3>> before = memberBoxes<3>(map, s), after = memberBoxes<3>(thin, s);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const std::size_t cell = thin.cellOf(i, s), cell_before = *map.find(thin.scale(s).keys[cell], s);
      const std::size_t i_before = map.gaussiansOf(cell_before, s).first + i - thin.gaussiansOf(cell, s).first;
      const Vector<3> centre = thin.grid().centre(thin.scale(s).keys[cell], s);
      const Vector<3> half = Vector<3>::Constant(0.5 * thin.grid().side(s));
      if (thin.isLeaf(cell, s)) expectBox<3>(after[i], centre - half, centre + half);
      leaves += thin.isLeaf(cell, s) ? 1 : 0;
      EXPECT_TRUE((after[i].low.array() <= before[i_before].low.array() + 1e-9).all()) << "something is cut off";
      EXPECT_TRUE((after[i].high.array() >= before[i_before].high.array() - 1e-9).all()) << "something is cut off";
    }
  }
  EXPECT_GT(leaves, 20u);
}

}  // namespace
}  // namespace gaussmap
